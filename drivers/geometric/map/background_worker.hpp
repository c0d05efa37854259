// SPDX-License-Identifier: MIT
// A thread that does one kind of job when asked, and hands its exceptions to the one who waits.
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace unisim::geometric {

class BackgroundWorker {
 public:
  /// @param threaded false: the job is done within start()
  BackgroundWorker(std::function<void()> job, bool threaded);
  ~BackgroundWorker();
  BackgroundWorker(const BackgroundWorker&) = delete;
  BackgroundWorker& operator=(const BackgroundWorker&) = delete;

  /// Begins the job; the last one must have been waited for.
  void start();
  /// Waits for the job. Throws what the job threw, once.
  void wait();

 private:
  void work();
  void loop();

  std::function<void()> job_;
  std::exception_ptr failure_;
  std::mutex mutex_;
  std::condition_variable changed_;
  bool asked_ = false;
  bool stop_ = false;
  std::thread thread_;
};

}  // namespace unisim::geometric
