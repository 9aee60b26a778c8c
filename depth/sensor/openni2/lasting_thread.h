#pragma once
#include <sys/types.h>

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace ossa::depth {

/// A thread that does what it is given, to the program's end. OpenNI2 keeps a list of all threads
/// that ever called it and looks whether they are alive when a new one does; the C library of today
/// crashes at that for one that has ended. So no thread of a program, which may end, calls OpenNI2.
class LastingThread {
 public:
  /// Never destroyed: `new`, and kept.
  LastingThread();
  ~LastingThread() = delete;
  LastingThread(const LastingThread&) = delete;
  LastingThread& operator=(const LastingThread&) = delete;

  /// Does it there and waits; throws what it throws.
  void Run(const std::function<void()>& task);
  /// Does it there some time, after what was asked for before.
  void Post(std::function<void()> task);

 private:
  bool IsElsewhere() const;
  [[noreturn]] void Work();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> tasks_;
  std::thread::id id_;
  pid_t process_;  // a child by fork has the object and not the thread
};

/// One such thread for as long as this lives. Those that are given back serve others: there are as
/// many as were ever needed at once.
class BorrowedThread {
 public:
  BorrowedThread();
  ~BorrowedThread();
  BorrowedThread(const BorrowedThread&) = delete;
  BorrowedThread& operator=(const BorrowedThread&) = delete;
  LastingThread* operator->() const { return thread_; }

 private:
  LastingThread* thread_;
};

}  // namespace ossa::depth
