// SPDX-License-Identifier: Apache-2.0
#include "tests/virtual_rig/ptp/gphoto_client.h"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>
#include <utility>

namespace weft::virtual_rig {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

bool is_usb(const std::string& port) {
  return port.starts_with("usb:");
}

std::vector<std::uint8_t> bytes_of(CameraFile* file) {
  const char* data = nullptr;
  unsigned long size = 0;
  if (gp_file_get_data_and_size(file, &data, &size) < 0 || !data) return {};
  return {data, data + size};
}

}  // namespace

const std::string& private_home() {
  static const std::string home = [] {
    std::string folder = testing::TempDir() + "gphoto_home_XXXXXX";
    if (!mkdtemp(folder.data())) std::abort();
    setenv("HOME", folder.c_str(), 1);
    return folder;
  }();
  return home;
}

GphotoClient::GphotoClient(std::string port) : port_(std::move(port)), context_(gp_context_new()) {
  private_home();
  std::signal(SIGPIPE, SIG_IGN);
}

GphotoClient::~GphotoClient() {
  exit();
  gp_context_unref(context_);
}

int GphotoClient::init() {
  exit();
  static CameraAbilitiesList* const abilities = [this] {
    CameraAbilitiesList* list = nullptr;
    gp_abilities_list_new(&list);
    gp_abilities_list_load(list, context_);
    return list;
  }();
  CameraAbilities model;
  const char* const name = is_usb(port_) ? "Nikon DSC D5100 (PTP mode)" : "PTP/IP Camera";
  gp_abilities_list_get_abilities(abilities, gp_abilities_list_lookup_model(abilities, name), &model);

  GPPortInfoList* ports = nullptr;
  gp_port_info_list_new(&ports);
  gp_port_info_list_load(ports);
  GPPortInfo port;
  int code = gp_port_info_list_lookup_path(ports, port_.c_str());
  if (code >= 0) {
    gp_port_info_list_get_info(ports, code, &port);
    gp_camera_new(&camera_);
    gp_camera_set_abilities(camera_, model);
    gp_camera_set_port_info(camera_, port);
    code = gp_camera_init(camera_, context_);
    if (code < 0) gp_camera_unref(std::exchange(camera_, nullptr));
  }
  gp_port_info_list_free(ports);
  return code;
}

int GphotoClient::init_within(double deadline_s) {
  const auto start = Clock::now();
  int code = init();
  while (code < 0 && seconds_since(start) < deadline_s) {
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    code = init();
  }
  return code;
}

int GphotoClient::exit() {
  if (!camera_) return GP_OK;
  const int code = gp_camera_exit(camera_, context_);
  gp_camera_unref(std::exchange(camera_, nullptr));
  return code;
}

CameraWidget* GphotoClient::setting(const char* name) {
  CameraWidget* widget = nullptr;
  return gp_camera_get_single_config(camera_, name, &widget, context_) < 0 ? nullptr : widget;
}

int GphotoClient::set(const char* name, const char* value) {
  CameraWidget* const widget = setting(name);
  if (!widget) return GP_ERROR_BAD_PARAMETERS;
  CameraWidgetType type;
  gp_widget_get_type(widget, &type);
  const int number = std::atoi(value);
  int code = GP_OK;
  if (type == GP_WIDGET_TOGGLE || type == GP_WIDGET_DATE)
    code = gp_widget_set_value(widget, &number);
  else
    code = gp_widget_set_value(widget, value);
  if (code >= 0) code = gp_camera_set_single_config(camera_, name, widget, context_);
  gp_widget_unref(widget);
  return code;
}

std::string GphotoClient::get(const char* name) {
  CameraWidget* const widget = setting(name);
  if (!widget) return "";
  CameraWidgetType type;
  gp_widget_get_type(widget, &type);
  std::string text;
  if (type == GP_WIDGET_TOGGLE || type == GP_WIDGET_DATE) {
    int number = 0;
    gp_widget_get_value(widget, &number);
    text = std::to_string(number);
  } else {
    const char* value = nullptr;
    gp_widget_get_value(widget, &value);
    if (value) text = value;
  }
  gp_widget_unref(widget);
  return text;
}

bool GphotoClient::read_only(const char* name) {
  CameraWidget* const widget = setting(name);
  int fixed = -1;
  if (widget) gp_widget_get_readonly(widget, &fixed);
  if (widget) gp_widget_unref(widget);
  return fixed == 1;
}

std::vector<std::string> GphotoClient::choices(const char* name) {
  CameraWidget* const widget = setting(name);
  std::vector<std::string> found;
  for (int i = 0; widget && i < gp_widget_count_choices(widget); ++i) {
    const char* choice = nullptr;
    gp_widget_get_choice(widget, i, &choice);
    found.emplace_back(choice);
  }
  if (widget) gp_widget_unref(widget);
  return found;
}

int GphotoClient::trigger() {
  return gp_camera_trigger_capture(camera_, context_);
}

GphotoClient::Event GphotoClient::wait(int timeout_ms) {
  Event event;
  void* data = nullptr;
  event.code = gp_camera_wait_for_event(camera_, timeout_ms, &event.type, &data, context_);
  if (event.code >= 0 && event.type == GP_EVENT_FILE_ADDED) event.path = *static_cast<CameraFilePath*>(data);
  std::free(data);
  return event;
}

GphotoClient::File GphotoClient::fetch(const CameraFilePath& path) {
  File file;
  CameraFileInfo info = {};
  if (gp_camera_file_get_info(camera_, path.folder, path.name, &info, context_) >= 0)
    file.said_bytes = info.file.size;
  CameraFile* handle = nullptr;
  gp_file_new(&handle);
  file.code = gp_camera_file_get(camera_, path.folder, path.name, GP_FILE_TYPE_NORMAL, handle, context_);
  file.bytes = bytes_of(handle);
  gp_file_unref(handle);
  return file;
}

GphotoClient::File GphotoClient::preview() {
  File file;
  CameraFile* handle = nullptr;
  gp_file_new(&handle);
  file.code = gp_camera_capture_preview(camera_, handle, context_);
  file.bytes = bytes_of(handle);
  gp_file_unref(handle);
  return file;
}

int GphotoClient::remove(const CameraFilePath& path) {
  return gp_camera_file_delete(camera_, path.folder, path.name, context_);
}

GphotoClient::Shot GphotoClient::shoot(double deadline_s) {
  const auto start = Clock::now();
  Shot shot;
  shot.triggered = trigger();
  if (shot.triggered >= 0) {
    const int triggered = shot.triggered;
    shot = next_file(deadline_s);
    shot.triggered = triggered;
  }
  shot.seconds = seconds_since(start);
  return shot;
}

GphotoClient::Shot GphotoClient::next_file(double deadline_s) {
  const auto start = Clock::now();
  Shot shot;
  while (!shot.added && seconds_since(start) < deadline_s) {
    const Event event = wait(100);
    shot.waited = event.code;
    if (event.code < 0) break;
    shot.added = event.type == GP_EVENT_FILE_ADDED;
    if (!shot.added) continue;
    shot.file = fetch(event.path);
    remove(event.path);
  }
  shot.seconds = seconds_since(start);
  return shot;
}

}  // namespace weft::virtual_rig
