// SPDX-License-Identifier: MIT
// A thread that does one kind of job when asked.
#include "drivers/geometric/map/background_worker.hpp"

#include <utility>

namespace unisim::geometric {

BackgroundWorker::BackgroundWorker(std::function<void()> job, bool threaded)
    : job_(std::move(job)) {
  if (threaded) thread_ = std::thread([this] { loop(); });
}

BackgroundWorker::~BackgroundWorker() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void BackgroundWorker::work() {
  // An exception that left the thread's function would end the program.
  try {
    job_();
  } catch (...) {
    failure_ = std::current_exception();
  }
}

void BackgroundWorker::start() {
  if (!thread_.joinable()) {
    work();
    return;
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    asked_ = true;
  }
  changed_.notify_all();
}

void BackgroundWorker::loop() {
  std::unique_lock<std::mutex> lock(mutex_);
  for (;;) {
    changed_.wait(lock, [this] { return asked_ || stop_; });
    if (stop_) return;
    lock.unlock();
    work();
    lock.lock();
    asked_ = false;
    changed_.notify_all();
  }
}

void BackgroundWorker::wait() {
  if (thread_.joinable()) {
    std::unique_lock<std::mutex> lock(mutex_);
    changed_.wait(lock, [this] { return !asked_; });
  }
  if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
}

}  // namespace unisim::geometric
