# SPDX-License-Identifier: Apache-2.0
# What is installed beside programs, and the Debian package made of all of it (docs/packaging.md).
include(GNUInstallDirs)
set(CMAKE_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS
  OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(package ${PROJECT_SOURCE_DIR}/cmake/package)
get_property(firmware_hex GLOBAL PROPERTY WEFT_FIRMWARE_HEX)

# Programs that people call, and those that weft starts.
install(TARGETS weft DESTINATION ${CMAKE_INSTALL_BINDIR})
install(TARGETS weft-work weft-camera weft-bench DESTINATION ${CMAKE_INSTALL_LIBEXECDIR}/weft)

# Pages and completions, as the build wrote them. A page is packed as Debian wants it, without a date.
foreach(pages ${PROJECT_BINARY_DIR}/app/cli/manuals ${PROJECT_BINARY_DIR}/bench/program/manuals)
  install(CODE "
    file(GLOB pages ${pages}/man1/*.1)
    foreach(page \${pages})
      get_filename_component(name \${page} NAME)
      execute_process(COMMAND gzip -9nc \${page} OUTPUT_FILE ${pages}/\${name}.gz COMMAND_ERROR_IS_FATAL ANY)
      file(INSTALL ${pages}/\${name}.gz DESTINATION \${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_MANDIR}/man1)
    endforeach()")
endforeach()
set(completions ${PROJECT_BINARY_DIR}/app/cli/manuals/completions)
install(FILES ${completions}/weft.bash DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions RENAME weft)
install(FILES ${completions}/weft.zsh DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions RENAME _weft)
install(FILES ${completions}/weft.fish DESTINATION ${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d)

# What documents may hold.
install(DIRECTORY ${PROJECT_BINARY_DIR}/app/cli/manuals/schemas DESTINATION ${CMAKE_INSTALL_DATADIR}/weft)

# The desktop.
install(FILES ${package}/weft.desktop DESTINATION ${CMAKE_INSTALL_DATADIR}/applications)
install(FILES ${package}/weft.svg DESTINATION ${CMAKE_INSTALL_DATADIR}/icons/hicolor/scalable/apps)
install(FILES ${package}/org.weft.weft.metainfo.xml DESTINATION ${CMAKE_INSTALL_DATADIR}/metainfo)

# Scenes to simulate, and the firmware of the board.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/testdata/scenes/ DESTINATION ${CMAKE_INSTALL_DATADIR}/weft/scenes
  FILES_MATCHING PATTERN "*.toml")
install(FILES ${firmware_hex} DESTINATION ${CMAKE_INSTALL_DATADIR}/weft/firmware RENAME weft.hex)

# Pages to read. What `./dev package` made: changelogs, and the bill of materials.
install(FILES ${PROJECT_SOURCE_DIR}/README.md DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/docs DESTINATION ${CMAKE_INSTALL_DOCDIR}
  FILES_MATCHING PATTERN "*.md" PATTERN "*.svg")
install(FILES ${package}/lintian-overrides DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides RENAME weft)
install(FILES ${package}/copyright DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(DIRECTORY ${PROJECT_BINARY_DIR}/package/doc/ DESTINATION ${CMAKE_INSTALL_DOCDIR} OPTIONAL)

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME weft)
set(CPACK_PACKAGE_CONTACT "weft developers <weft@weft.example>")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_THREADS 1)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS ${CMAKE_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS})
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
# What is started by name and linked by nobody.
set(CPACK_DEBIAN_PACKAGE_RECOMMENDS "systemd, udev, xdg-utils")
set(CPACK_DEBIAN_PACKAGE_SUGGESTS "avrdude, gphoto2, rclone, slurm-client")
set(CPACK_DEBIAN_PACKAGE_DESCRIPTION "photometric-stereo textile scanner
weft turns photographs of a piece of cloth, each lit by one LED, into albedo,
normal, height and roughness maps with their true size, and into materials
that renderers and game engines open.

It runs the rig of camera and LED board, calibrates it, solves scans, and
serves a page for all of that. A simulator makes scans with their truth, so
that everything can be tried without a rig.")
set(CPACK_DEBIAN_PACKAGE_CONTROL_EXTRA ${package}/postinst ${package}/prerm ${package}/postrm)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
include(CPack)
