// SPDX-License-Identifier: Apache-2.0
// weft-camera: one camera behind libgphoto2, in a process that can be killed. See capture/camera/worker.h.
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <ctime>

#include "capture/camera/gphoto_camera.h"
#include "capture/camera/worker.h"

int main() {
  // A camera that closes its connection must not end the process.
  std::signal(SIGPIPE, SIG_IGN);
  // libgphoto2 turns the camera's clock into a count by the local time zone, daylight saving included.
  setenv("TZ", "UTC", 1);
  tzset();
  weft::capture::GphotoCamera::set_up_library();
  weft::capture::serve_camera(STDIN_FILENO, STDOUT_FILENO);
}
