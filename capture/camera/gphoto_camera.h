// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "core/base/result.h"

namespace weft::capture {

/// A camera as libgphoto2 addresses one.
struct CameraAddress {
  std::string model;  ///< libgphoto2's name of it: "Nikon DSC D5100 (PTP mode)"
  std::string port;   ///< "usb:001,007", "ptpip:127.0.0.1:15740:15740"

  friend bool operator==(const CameraAddress&, const CameraAddress&) = default;
};

/// A file that a camera says it has.
struct CameraFileName {
  std::string folder, name;
};

/// The bytes of a photograph, held by libgphoto2.
class FetchedFile {
 public:
  FetchedFile(FetchedFile&& other) noexcept;
  FetchedFile& operator=(FetchedFile&&) = delete;
  ~FetchedFile();
  std::span<const std::uint8_t> bytes() const { return bytes_; }

 private:
  friend class GphotoCamera;
  explicit FetchedFile(void* file) : file_(file) {}
  void* file_;
  std::span<const std::uint8_t> bytes_;
};

/// One camera through libgphoto2, the only door to it. A call may block for as long as libgphoto2 does (2.5 s
/// a packet over PTP/IP, 20 s over USB, 1000 s where a body stays busy), and a camera that lies about sizes
/// may crash the process: this runs in weft-camera, which can be killed.
///
/// Errors: kNoDevice (gone, or another program has it), kTryAgain (no answer in time, or none that makes
/// sense), kBadData (refuses a value), kProtocol (a file that is not whole).
class GphotoCamera {
 public:
  /// To be called once before anything else of a process: reads properties afresh each time, so that a value
  /// read back is the camera's, and resets a body on USB that lets OpenSession wait for 1.5 s, twice at most.
  /// The library keeps what it remembers in $HOME/.gphoto.
  static void set_up_library();
  /// Loads the library's drivers, once a process, and has them look for ports. It asks no camera, and takes
  /// some 40 ms; where the disk with the drivers, or any disk that is mounted, hangs, as long as that does.
  static Result<void> load_drivers();
  /// The cameras that libgphoto2 knows among what is plugged in.
  static Result<std::vector<CameraAddress>> on_usb();
  static Result<std::unique_ptr<GphotoCamera>> open(const CameraAddress& address);
  /// Ends the session with the camera.
  ~GphotoCamera();
  GphotoCamera(const GphotoCamera&) = delete;
  GphotoCamera& operator=(const GphotoCamera&) = delete;

  const CameraAddress& address() const { return address_; }
  bool has(const std::string& widget);
  /// A widget's value as text; of a date, seconds since 1970 in the time zone of this process.
  Result<std::string> value(const std::string& widget);
  Result<std::vector<std::string>> choices(const std::string& widget);
  /// Sets a value and reads it back.
  Result<void> set(const std::string& widget, const std::string& value);

  /// A picture of live view (JPEG), which is started where it is off: libgphoto2 throws its first one away.
  Result<FetchedFile> preview();
  /// Whether live view is on.
  Result<bool> is_live();
  Result<void> end_live();

  /// Releases the shutter. Returns once it has closed, or at once, by the kind of body
  /// (CameraProfile::Trigger). Success does not prove that it opened: a body that was busy says the same.
  Result<void> trigger();
  /// Waits for the next event, and polls more often the shorter `most_ms` is. The download of a photograph in
  /// the camera's memory happens within and is not bounded by it.
  struct Event {
    bool quiet = false;                  ///< nothing came
    std::optional<CameraFileName> file;  ///< a photograph has arrived
  };
  Result<Event> wait_for_event(int most_ms);
  /// The file whole, its size compared with what the camera said it is.
  Result<FetchedFile> fetch(const CameraFileName& file);
  /// Frees what camera and library hold of a file. Of a photograph that came from a body's memory ("capt...")
  /// libgphoto2 2.5.30 drops its own copy alone: the body has freed its when it was fetched.
  void forget(const CameraFileName& file);

 private:
  struct Handles;
  GphotoCamera(CameraAddress address, std::unique_ptr<Handles> handles);
  Error failed(int code, const std::string& what) const;

  CameraAddress address_;
  std::unique_ptr<Handles> handles_;
  bool odd_event_ = false;  // the last wait ended with -1
};

}  // namespace weft::capture
