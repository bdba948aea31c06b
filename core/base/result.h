// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <variant>

namespace weft {

/// What kind of failure this is. `app` turns the kind into an exit code; nothing else depends on it.
enum class ErrorKind {
  kUsage,         ///< the caller's options do not make sense
  kBadData,       ///< the input was read, and is wrong
  kNoInput,       ///< the input is not there or may not be read
  kNoDevice,      ///< a device is not there
  kInternal,      ///< a broken promise of our own code
  kCannotCreate,  ///< an output may not be created
  kInputOutput,   ///< reading or writing failed half-way
  kTryAgain,      ///< busy or out of a resource for now
  kProtocol,      ///< a device answered against its protocol
  kInterrupted,   ///< the person at the keyboard stopped it
};

/// An error as a person needs it: what happened, where, why, and what to do next.
struct Error {
  ErrorKind kind = ErrorKind::kInternal;
  std::string what;    ///< "raw frame is truncated"
  std::string where;   ///< the file, key or device: "raw/03_led03.dng"
  std::string why;     ///< "1 byte is missing of 32 170 000"
  std::string remedy;  ///< "copy the session again from the rig's disk"

  /// One paragraph: "what: where: why. remedy."
  std::string message() const;
};

/// A value or the Error that prevented it. Follows std::expected of C++23 in its names.
template <typename T>
class [[nodiscard]] Result {
 public:
  Result(T value) : state_(std::move(value)) {}      // NOLINT(google-explicit-constructor)
  Result(Error error) : state_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

  bool has_value() const { return state_.index() == 0; }
  explicit operator bool() const { return has_value(); }

  T& value() & { return std::get<0>(state_); }
  const T& value() const& { return std::get<0>(state_); }
  T&& value() && { return std::get<0>(std::move(state_)); }
  T& operator*() & { return value(); }
  const T& operator*() const& { return value(); }
  T&& operator*() && { return std::move(*this).value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  const Error& error() const& { return std::get<1>(state_); }
  Error&& error() && { return std::get<1>(std::move(state_)); }

 private:
  std::variant<T, Error> state_;
};

/// Success without a value, or an Error.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

  bool has_value() const { return !error_.has_value(); }
  explicit operator bool() const { return has_value(); }
  const Error& error() const& { return *error_; }
  Error&& error() && { return std::move(*error_); }

 private:
  std::optional<Error> error_;
};

}  // namespace weft
