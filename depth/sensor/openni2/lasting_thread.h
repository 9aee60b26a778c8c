#pragma once
#include <sys/types.h>

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace ossa::depth {

/// A worker thread that lives until the program ends. OpenNI2 keeps a list of all threads that ever
/// called it and checks whether they are alive when a new one does; glibc crashes on that check for
/// ended threads. So no thread of a program, which may end, calls OpenNI2.
class LastingThread {
 public:
  /// Must never be destroyed: allocate it with `new` and keep it.
  LastingThread();
  ~LastingThread() = delete;
  LastingThread(const LastingThread&) = delete;
  LastingThread& operator=(const LastingThread&) = delete;

  /// Runs the task on the thread and waits; rethrows its exceptions.
  void Run(const std::function<void()>& task);
  /// Runs the task asynchronously, after earlier ones.
  void Post(std::function<void()> task);

 private:
  bool IsElsewhere() const;
  [[noreturn]] void Work();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::function<void()>> tasks_;
  std::thread::id id_;
  pid_t process_;  // a forked child has the object but not the thread
};

/// A lasting thread for exclusive use during this object's lifetime. Returned threads are reused:
/// there are as many as were ever needed at once.
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
