# The shared library and what is installed beside the program: headers, CMake's and pkg-config's files.
#
# Components, for packages: runtime (program and data), library (libaftershade.so.N), development (the rest).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# Before 1.0 a minor version may change the ABI.
if(PROJECT_VERSION_MAJOR EQUAL 0)
  set(AFTERSHADE_SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
else()
  set(AFTERSHADE_SOVERSION ${PROJECT_VERSION_MAJOR})
endif()

configure_file(cmake/exports.map.in exports.map @ONLY)
add_library(aftershade_shared SHARED $<TARGET_OBJECTS:aftershade_host>)
target_link_libraries(aftershade_shared PRIVATE aftershade_compare aftershade_inspect aftershade_run fmt::fmt Threads::Threads)
target_link_options(aftershade_shared PRIVATE -Wl,--version-script,${PROJECT_BINARY_DIR}/exports.map -Wl,--as-needed)
if(NOT AFTERSHADE_SANITIZE)
  target_link_options(aftershade_shared PRIVATE -Wl,-z,defs)
endif()
set_target_properties(aftershade_shared PROPERTIES
  OUTPUT_NAME aftershade VERSION ${PROJECT_VERSION} SOVERSION ${AFTERSHADE_SOVERSION} EXPORT_NAME host
  LINK_DEPENDS ${PROJECT_BINARY_DIR}/exports.map LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR})
target_include_directories(aftershade_shared INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_features(aftershade_shared INTERFACE cxx_std_20)

# What authors of native plug-ins need: a header and nothing to link.
add_library(aftershade_plugin INTERFACE)
add_library(aftershade::plugin ALIAS aftershade_plugin)
set_target_properties(aftershade_plugin PROPERTIES EXPORT_NAME plugin)
target_include_directories(aftershade_plugin INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/framework/plugin> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)

install(TARGETS aftershade RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT runtime)
install(DIRECTORY blender effects glsl looks page profiles DESTINATION share/aftershade COMPONENT runtime)
install(DIRECTORY ${PROJECT_BINARY_DIR}/printed/man1 DESTINATION share/man COMPONENT runtime)
install(FILES ${PROJECT_BINARY_DIR}/printed/completions/aftershade DESTINATION share/bash-completion/completions
        COMPONENT runtime)
install(FILES ${PROJECT_BINARY_DIR}/printed/completions/_aftershade DESTINATION share/zsh/vendor-completions
        COMPONENT runtime)
install(FILES ${PROJECT_BINARY_DIR}/printed/completions/aftershade.fish DESTINATION share/fish/vendor_completions.d
        COMPONENT runtime)
install(TARGETS aftershade_shared aftershade_plugin EXPORT aftershadeTargets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT library NAMELINK_COMPONENT development)
install(DIRECTORY framework/host/include/aftershade DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)
install(FILES framework/plugin/aftershade_plugin.h DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT development)

set(PACKAGE_FOLDER ${CMAKE_INSTALL_LIBDIR}/cmake/aftershade)
set(AFTERSHADE_DATA_FOLDER share/aftershade)
install(EXPORT aftershadeTargets NAMESPACE aftershade:: DESTINATION ${PACKAGE_FOLDER} COMPONENT development)
configure_package_config_file(cmake/aftershadeConfig.cmake.in ${PROJECT_BINARY_DIR}/aftershadeConfig.cmake
  INSTALL_DESTINATION ${PACKAGE_FOLDER} PATH_VARS AFTERSHADE_DATA_FOLDER NO_CHECK_REQUIRED_COMPONENTS_MACRO)
# As the soname: before 1.0 only patches are compatible.
if(PROJECT_VERSION_MAJOR EQUAL 0)
  set(COMPATIBLE SameMinorVersion)
else()
  set(COMPATIBLE SameMajorVersion)
endif()
write_basic_package_version_file(${PROJECT_BINARY_DIR}/aftershadeConfigVersion.cmake COMPATIBILITY ${COMPATIBLE})
install(FILES ${PROJECT_BINARY_DIR}/aftershadeConfig.cmake ${PROJECT_BINARY_DIR}/aftershadeConfigVersion.cmake
        DESTINATION ${PACKAGE_FOLDER} COMPONENT development)

# Its prefix is where it lies, so that a package may be moved.
file(RELATIVE_PATH PREFIX_FROM_PC /${CMAKE_INSTALL_LIBDIR}/pkgconfig /)
string(REGEX REPLACE "/$" "" PREFIX_FROM_PC ${PREFIX_FROM_PC})
configure_file(cmake/aftershade.pc.in aftershade.pc @ONLY)
install(FILES ${PROJECT_BINARY_DIR}/aftershade.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig COMPONENT development)
