// SPDX-License-Identifier: Apache-2.0
#include "capture/camera/gphoto_camera.h"

#include <fmt/format.h>
#include <gphoto2/gphoto2-setting.h>
#include <gphoto2/gphoto2.h>

#include <cstdlib>
#include <utility>

namespace weft::capture {
namespace {

template <auto kFree>
struct Freed {
  template <typename T>
  void operator()(T* handle) const {
    kFree(handle);
  }
};
using Context = std::unique_ptr<GPContext, Freed<&gp_context_unref>>;
using Abilities = std::unique_ptr<CameraAbilitiesList, Freed<&gp_abilities_list_free>>;
using Ports = std::unique_ptr<GPPortInfoList, Freed<&gp_port_info_list_free>>;
using List = std::unique_ptr<CameraList, Freed<&gp_list_free>>;
using Widget = std::unique_ptr<CameraWidget, Freed<&gp_widget_free>>;

/// Fills the first handle and hands it over.
template <typename Owner, typename Make, typename... Arguments>
Owner make(Make make_handle, Arguments... arguments) {
  typename Owner::pointer handle = nullptr;
  return Owner(make_handle(&handle, arguments...) < 0 ? nullptr : handle);
}

const char kHeldRemedy[] =
    "close the other program; if it is the desktop's, run `gio mount -s gphoto2`, and "
    "`systemctl --user mask gvfs-gphoto2-volume-monitor` for good";

Error error_of(int code, const std::string& what, const std::string& where, const std::string& details) {
  const std::string why = details.empty() ? gp_result_as_string(code) : details;
  switch (code) {
    case GP_ERROR_IO_USB_CLAIM:
    case GP_ERROR_IO_LOCK:
      return {ErrorKind::kNoDevice, "another program holds the camera", where, why, kHeldRemedy};
    case GP_ERROR_IO_USB_FIND:
    case GP_ERROR_UNKNOWN_PORT:
      return {ErrorKind::kNoDevice, "the camera is gone", where, why,
              "switch it on and check its cable; it is found again by itself"};
    case GP_ERROR_BAD_PARAMETERS:
    case GP_ERROR_NOT_SUPPORTED:
      return {ErrorKind::kBadData, what, where, why, "check the camera's mode dial and its profile"};
    default:
      return {ErrorKind::kTryAgain, what, where, why, "take the photograph again"};
  }
}

/// One process does it once.
Result<CameraAbilitiesList*> known_cameras(GPContext* context) {
  static const Abilities list = [context] {
    Abilities loading = make<Abilities>(&gp_abilities_list_new);
    if (loading && gp_abilities_list_load(loading.get(), context) < 0) loading.reset();
    return loading;
  }();
  if (list && gp_abilities_list_count(list.get()) > 0) return list.get();
  return Error{ErrorKind::kNoInput, "libgphoto2 has no camera drivers", "CAMLIBS", "none could be loaded",
               "install libgphoto2-6"};
}

Result<Ports> ports_now() {
  Ports list = make<Ports>(&gp_port_info_list_new);
  if (list && gp_port_info_list_load(list.get()) >= 0) return list;
  return Error{ErrorKind::kNoInput, "libgphoto2 has no port drivers", "IOLIBS", "none could be loaded",
               "install libgphoto2-port12"};
}

constexpr const char *kViewfinder = "viewfinder", *kOn = "1", *kOff = "0";

std::string text_of(CameraWidget* widget) {
  CameraWidgetType type = GP_WIDGET_TEXT;
  gp_widget_get_type(widget, &type);
  if (type == GP_WIDGET_TOGGLE || type == GP_WIDGET_DATE) {
    int number = 0;
    gp_widget_get_value(widget, &number);
    return std::to_string(number);
  }
  if (type == GP_WIDGET_RANGE) {
    float number = 0;
    gp_widget_get_value(widget, &number);
    return fmt::format("{:g}", number);
  }
  const char* text = nullptr;
  gp_widget_get_value(widget, &text);
  return text == nullptr ? "" : text;
}

int set_text(CameraWidget* widget, const std::string& value) {
  CameraWidgetType type = GP_WIDGET_TEXT;
  gp_widget_get_type(widget, &type);
  if (type == GP_WIDGET_TOGGLE || type == GP_WIDGET_DATE) {
    const int number = static_cast<int>(std::strtol(value.c_str(), nullptr, 10));
    return gp_widget_set_value(widget, &number);
  }
  if (type == GP_WIDGET_RANGE) {
    const float number = std::strtof(value.c_str(), nullptr);
    return gp_widget_set_value(widget, &number);
  }
  return gp_widget_set_value(widget, value.c_str());
}

bool is_read_only(CameraWidget* widget) {
  int read_only = 0;
  gp_widget_get_readonly(widget, &read_only);
  return read_only != 0;
}

}  // namespace

FetchedFile::FetchedFile(FetchedFile&& other) noexcept
    : file_(std::exchange(other.file_, nullptr)), bytes_(std::exchange(other.bytes_, {})) {}

FetchedFile::~FetchedFile() {
  if (file_ != nullptr) gp_file_unref(static_cast<CameraFile*>(file_));
}

struct GphotoCamera::Handles {
  Context context{gp_context_new()};
  ::Camera* camera = nullptr;
  std::string details;  // of the last error, in libgphoto2's words

  Handles() {
    const auto note = [](GPContext*, const char* text, void* self) {
      static_cast<Handles*>(self)->details = text;
    };
    gp_context_set_error_func(context.get(), note, this);
  }
  ~Handles() {
    if (camera == nullptr) return;
    gp_camera_exit(camera, context.get());
    gp_camera_free(camera);
  }
  Handles(const Handles&) = delete;
  Handles& operator=(const Handles&) = delete;

  int read(const std::string& name, Widget& widget) const {
    CameraWidget* handle = nullptr;
    const int code = gp_camera_get_single_config(camera, name.c_str(), &handle, context.get());
    if (code >= 0) widget.reset(handle);
    return code;
  }
};

GphotoCamera::GphotoCamera(CameraAddress address, std::unique_ptr<Handles> handles)
    : address_(std::move(address)), handles_(std::move(handles)) {}

GphotoCamera::~GphotoCamera() = default;

Error GphotoCamera::failed(int code, const std::string& what) const {
  return error_of(code, what, address_.port, std::exchange(handles_->details, {}));
}

void GphotoCamera::set_up_library() {
  char driver[] = "ptp2";
  char cached[] = "cachetime", cached_s[] = "0";
  gp_setting_set(driver, cached, cached_s);
  char patience[] = "start_timeout", patience_ms[] = "1500";
  gp_setting_set(driver, patience, patience_ms);
}

Result<void> GphotoCamera::load_drivers() {
  const Context context(gp_context_new());
  if (const auto known = known_cameras(context.get()); !known) return known.error();
  if (const Result<Ports> ports = ports_now(); !ports) return ports.error();
  return {};
}

Result<std::vector<CameraAddress>> GphotoCamera::on_usb() {
  const Context context(gp_context_new());
  const auto known = known_cameras(context.get());
  if (!known) return known.error();
  const Result<Ports> ports = ports_now();
  if (!ports) return ports.error();
  const List found = make<List>(&gp_list_new);
  if (const int code = gp_abilities_list_detect(*known, ports->get(), found.get(), context.get()); code < 0)
    return error_of(code, "cameras on USB cannot be listed", "usb:", "");
  std::vector<CameraAddress> addresses;
  for (int i = 0; i < gp_list_count(found.get()); ++i) {
    const char *model = "", *port = "";
    gp_list_get_name(found.get(), i, &model);
    gp_list_get_value(found.get(), i, &port);
    addresses.push_back({model, port});
  }
  return addresses;
}

Result<std::unique_ptr<GphotoCamera>> GphotoCamera::open(const CameraAddress& address) {
  auto handles = std::make_unique<Handles>();
  const auto known = known_cameras(handles->context.get());
  if (!known) return known.error();
  const Result<Ports> ports = ports_now();
  if (!ports) return ports.error();

  CameraAbilities abilities;
  const int model = gp_abilities_list_lookup_model(*known, address.model.c_str());
  if (model < 0 || gp_abilities_list_get_abilities(*known, model, &abilities) < 0) {
    return Error{ErrorKind::kBadData, "libgphoto2 does not know this camera", address.model, "",
                 "use a name that `gphoto2 --list-cameras` shows in the camera profile"};
  }
  GPPortInfo port;
  const int at = gp_port_info_list_lookup_path(ports->get(), address.port.c_str());
  if (at < 0 || gp_port_info_list_get_info(ports->get(), at, &port) < 0)
    return error_of(GP_ERROR_UNKNOWN_PORT, "", address.port, "");

  gp_camera_new(&handles->camera);
  gp_camera_set_abilities(handles->camera, abilities);
  gp_camera_set_port_info(handles->camera, port);
  if (const int code = gp_camera_init(handles->camera, handles->context.get()); code < 0) {
    Error error = error_of(code, "the camera does not answer", address.port, handles->details);
    // Before a session stands, these say that nothing listens there.
    if (code == GP_ERROR_IO || code == GP_ERROR) error.kind = ErrorKind::kNoDevice;
    error.remedy = error.remedy == kHeldRemedy ? kHeldRemedy : "switch the camera on and check its cable";
    gp_camera_free(std::exchange(handles->camera, nullptr));
    return error;
  }
  return std::unique_ptr<GphotoCamera>(new GphotoCamera(address, std::move(handles)));
}

bool GphotoCamera::has(const std::string& widget) {
  Widget handle;
  return handles_->read(widget, handle) >= 0;
}

Result<std::string> GphotoCamera::value(const std::string& widget) {
  Widget handle;
  if (const int code = handles_->read(widget, handle); code < 0)
    return failed(code, "the camera does not tell its " + widget);
  return text_of(handle.get());
}

Result<std::vector<std::string>> GphotoCamera::choices(const std::string& widget) {
  Widget handle;
  if (const int code = handles_->read(widget, handle); code < 0)
    return failed(code, "the camera does not tell its " + widget);
  std::vector<std::string> listed;
  for (int i = 0; i < gp_widget_count_choices(handle.get()); ++i) {
    const char* text = nullptr;
    if (gp_widget_get_choice(handle.get(), i, &text) >= 0 && text != nullptr) listed.emplace_back(text);
  }
  return listed;
}

Result<void> GphotoCamera::set(const std::string& widget, const std::string& value) {
  Widget handle;
  const std::string what = "the camera does not take " + widget + " = " + value;
  if (const int code = handles_->read(widget, handle); code < 0) return failed(code, what);
  const std::string before = text_of(handle.get());
  if (before == value) return {};
  if (is_read_only(handle.get())) {
    return Error{ErrorKind::kBadData, what, address_.port, "it is " + before + " and can only be read",
                 "set it at the camera"};
  }
  int code = set_text(handle.get(), value);
  if (code >= 0) {
    code =
        gp_camera_set_single_config(handles_->camera, widget.c_str(), handle.get(), handles_->context.get());
  }
  if (code < 0) return failed(code, what);
  const Result<std::string> after = this->value(widget);
  if (!after) return after.error();
  if (*after == value) return {};
  return Error{ErrorKind::kBadData, what, address_.port, "it stays at " + *after, "set it at the camera"};
}

Result<FetchedFile> GphotoCamera::preview() {
  ::CameraFile* file = nullptr;
  gp_file_new(&file);
  FetchedFile fetched(file);
  if (const int code = gp_camera_capture_preview(handles_->camera, file, handles_->context.get()); code < 0)
    return failed(code, "the camera shows nothing in live view");
  const char* data = nullptr;
  unsigned long size = 0;  // NOLINT(google-runtime-int): libgphoto2's type
  gp_file_get_data_and_size(file, &data, &size);
  fetched.bytes_ = {reinterpret_cast<const std::uint8_t*>(data), size};
  return fetched;
}

Result<bool> GphotoCamera::is_live() {
  if (!has(kViewfinder)) return false;
  const Result<std::string> value = this->value(kViewfinder);
  if (!value) return value.error();
  return *value == kOn;
}

Result<void> GphotoCamera::end_live() {
  const Result<bool> live = is_live();
  if (!live) return live.error();
  return *live ? set(kViewfinder, kOff) : Result<void>();
}

Result<void> GphotoCamera::trigger() {
  const int code = gp_camera_trigger_capture(handles_->camera, handles_->context.get());
  if (code < 0) return failed(code, "the camera did not release its shutter");
  return {};
}

Result<GphotoCamera::Event> GphotoCamera::wait_for_event(int most_ms) {
  CameraEventType type = GP_EVENT_UNKNOWN;
  void* data = nullptr;
  const int code = gp_camera_wait_for_event(handles_->camera, most_ms, &type, &data, handles_->context.get());
  const std::unique_ptr<void, Freed<&std::free>> owned(data);
  Event event;
  // Once: an event about a property that libgphoto2 does not know (its issue 642). Twice: a broken link.
  if (code == GP_ERROR && !std::exchange(odd_event_, true)) return event;
  if (code < 0) return failed(code, "the camera broke off while it was sending");
  odd_event_ = false;
  event.quiet = type == GP_EVENT_TIMEOUT;
  if (type == GP_EVENT_FILE_ADDED) {
    const auto* path = static_cast<const CameraFilePath*>(data);
    event.file = CameraFileName{path->folder, path->name};
  }
  return event;
}

Result<FetchedFile> GphotoCamera::fetch(const CameraFileName& name) {
  ::CameraFile* file = nullptr;
  gp_file_new(&file);
  FetchedFile fetched(file);
  const int code = gp_camera_file_get(handles_->camera, name.folder.c_str(), name.name.c_str(),
                                      GP_FILE_TYPE_NORMAL, file, handles_->context.get());
  if (code < 0) return failed(code, "the photograph did not arrive");
  const char* data = nullptr;
  unsigned long size = 0;  // NOLINT(google-runtime-int): libgphoto2's type
  gp_file_get_data_and_size(file, &data, &size);
  CameraFileInfo info = {};
  const bool told = gp_camera_file_get_info(handles_->camera, name.folder.c_str(), name.name.c_str(), &info,
                                            handles_->context.get()) >= 0 &&
                    (info.file.fields & GP_FILE_INFO_SIZE) != 0;
  if (size == 0 || (told && info.file.size != size)) {
    return Error{ErrorKind::kProtocol, "the photograph is not whole", address_.port,
                 fmt::format("{} of {} bytes arrived", size, info.file.size), "take it again"};
  }
  fetched.bytes_ = {reinterpret_cast<const std::uint8_t*>(data), size};
  return fetched;
}

void GphotoCamera::forget(const CameraFileName& file) {
  gp_camera_file_delete(handles_->camera, file.folder.c_str(), file.name.c_str(), handles_->context.get());
  handles_->details.clear();
}

}  // namespace weft::capture
