// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gphoto2/gphoto2.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace weft::virtual_rig {

/// The real libgphoto2 at a camera, a line a call. Its settings are in a HOME of this process's own.
class GphotoClient {
 public:
  /// "ptpip:127.0.0.1:PORT:PORT", "usb:001,007"; nothing is called yet.
  explicit GphotoClient(std::string port);
  ~GphotoClient();
  GphotoClient(const GphotoClient&) = delete;
  GphotoClient& operator=(const GphotoClient&) = delete;

  /// All below return libgphoto2's code: negative for an error.
  int init();
  /// Tries again until it succeeds or time is out.
  int init_within(double deadline_s);
  int exit();
  int set(const char* name, const char* value);
  int trigger();

  /// What a setting reads, "" if there is none.
  std::string get(const char* name);
  bool read_only(const char* name);
  std::vector<std::string> choices(const char* name);

  struct Event {
    int code = 0;
    CameraEventType type = GP_EVENT_TIMEOUT;
    CameraFilePath path = {};
  };
  Event wait(int timeout_ms);

  struct File {
    int code = 0;
    std::uint64_t said_bytes = 0;  ///< by its information
    std::vector<std::uint8_t> bytes;
  };
  File fetch(const CameraFilePath& path);
  /// A picture of live view, which is started where it is off.
  File preview();
  int remove(const CameraFilePath& path);

  struct Shot {
    int triggered = 0, waited = 0;
    bool added = false;  ///< a file was announced
    File file;
    double seconds = 0;
    bool whole() const { return triggered >= 0 && waited >= 0 && added && file.code >= 0; }
  };
  /// Triggers, waits for a file as long as the deadline allows, fetches and deletes it.
  Shot shoot(double deadline_s = 5);
  /// Waits for a file that comes by itself.
  Shot next_file(double deadline_s);

 private:
  CameraWidget* setting(const char* name);

  std::string port_;
  GPContext* context_;
  Camera* camera_ = nullptr;
};

/// A folder made for this process alone, which is HOME from then on.
const std::string& private_home();

}  // namespace weft::virtual_rig
