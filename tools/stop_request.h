// How a signal ends the program: a job that can stop by itself does, and any other one is ended within a second.
// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <thread>

namespace umbrick::tools {

/// While the object of this class lives, which is in main, SIGINT, SIGTERM and SIGHUP ask the job to stop, and so does
/// SIGUSR1, which mpirun and Slurm pass on to the ranks of a job. If it has
/// not ended most of a second later, temporary files are removed and the program ends by the signal, whatever it is
/// about: it may wait for a pipe, or for a library. A second signal does so at once. A signal that the program was told
/// to ignore, as nohup does, stays ignored. A pipe without a reader and a file that is too large (SIGPIPE, SIGXFSZ) are
/// errors of what is written there, and no signals.
class SignalWatch {
 public:
  SignalWatch();
  ~SignalWatch();
  SignalWatch(const SignalWatch&) = delete;
  SignalWatch& operator=(const SignalWatch&) = delete;

 private:
  std::thread watcher_;
};

/// Whether the user wants the job to stop.
class StopRequest {
 public:
  StopRequest() = default;
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;
  /// From now on there is something to keep: a job that finds out about the request gets the time to write it.
  void keepParts();
  bool requested() const;
};

/// Whether a signal has asked for the end of the program. A job asks its StopRequest instead.
bool stopRequested();

/// The job has ended by itself and said what there is to say: what is left to do is not cut short by a signal that came
/// before.
void endsByItself();

/// Ends the program with this status if a signal has asked for that, once all that is to be written is. OpenGL, threads
/// and memory are left to the system: to tear them down takes long on a busy machine.
void leaveIfStopped(int status);

}  // namespace umbrick::tools
