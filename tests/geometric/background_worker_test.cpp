// SPDX-License-Identifier: MIT
// A job in the background: done when waited for, and its failure reaches the one who waits.
#include "drivers/geometric/map/background_worker.hpp"

#include <new>
#include <stdexcept>

#include "tests/support/catch.hpp"

namespace unisim::geometric::test {

TEST_CASE("a job is done once it has been waited for") {
  for (const bool threaded : {false, true}) {
    int done = 0;
    BackgroundWorker worker([&] { ++done; }, threaded);
    worker.wait();
    CHECK(done == 0);
    for (int round = 1; round <= 3; ++round) {
      worker.start();
      worker.wait();
      CHECK(done == round);
    }
  }
}

TEST_CASE("what a job throws reaches the one who waits, and the next job runs") {
  for (const bool threaded : {false, true}) {
    int rounds = 0;
    const auto job = [&] {
      if (++rounds == 1) throw std::runtime_error("broken");
      if (rounds == 2) throw std::bad_alloc();
    };
    BackgroundWorker worker(job, threaded);
    worker.start();
    CHECK_THROWS_AS(worker.wait(), std::runtime_error);
    worker.wait();
    worker.start();
    CHECK_THROWS_AS(worker.wait(), std::bad_alloc);
    worker.start();
    CHECK_NOTHROW(worker.wait());
    CHECK(rounds == 3);
    worker.start();  // not waited for: the end waits
  }
}

}  // namespace unisim::geometric::test
