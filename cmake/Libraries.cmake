# SPDX-License-Identifier: Apache-2.0
# Every library we build on, each from Debian 12. `./dev` installs them.
find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(fmt REQUIRED CONFIG)
find_package(spdlog REQUIRED CONFIG)
find_package(nlohmann_json REQUIRED CONFIG)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(hwy REQUIRED CONFIG)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(embree 3.13 REQUIRED CONFIG)
find_package(OpenEXR 3.1 REQUIRED CONFIG)
find_package(TIFF 4.5 REQUIRED)
find_package(PNG 1.6 REQUIRED)
find_package(JPEG REQUIRED)  # libjpeg-turbo
find_package(OpenCV 4.6 REQUIRED COMPONENTS core imgproc calib3d objdetect aruco mcc)
find_package(Ceres 2.1 REQUIRED)
find_package(CLI11 REQUIRED CONFIG)
find_package(tomlplusplus REQUIRED CONFIG)
find_package(GTest REQUIRED CONFIG)
pkg_check_modules(LIBRAW_R REQUIRED IMPORTED_TARGET libraw_r)
pkg_check_modules(GPHOTO2 REQUIRED IMPORTED_TARGET libgphoto2)
pkg_check_modules(SERIALPORT REQUIRED IMPORTED_TARGET libserialport)
pkg_check_modules(HTTPLIB REQUIRED IMPORTED_TARGET cpp-httplib)
pkg_check_modules(SIMAVR REQUIRED IMPORTED_TARGET simavr)  # GPL-3: only the virtual rig links it
find_library(SQUISH_LIBRARY squish REQUIRED)  # its pkg-config file names a folder that is not there
find_package(SQLite3 3.40 REQUIRED)
find_package(ZLIB REQUIRED)
pkg_check_modules(LIBUSB REQUIRED IMPORTED_TARGET libusb-1.0)  # its header, for the stand-in
if(NOT WEFT_PLAIN_THREADS)
  find_package(TBB REQUIRED CONFIG)
endif()
