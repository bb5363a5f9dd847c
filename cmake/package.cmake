# Debian packages by CPack; scripts/make-packages makes them. Each is a component of cmake/install.cmake.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME aftershade)
set(CPACK_PACKAGE_CONTACT "The Aftershade developers <aftershade@users.noreply.github.com>")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR})
set(CPACK_COMPONENTS_ALL runtime library development)

# Mesa's drivers are opened at run time, so that no tool finds these dependencies. EGL is on every release; OSMesa, which draws
# the same, on some.
set(gl_packages "libegl1, libegl-mesa0, libgl1-mesa-dri")
set(library_package libaftershade${AFTERSHADE_SOVERSION})

set(CPACK_DEBIAN_RUNTIME_PACKAGE_NAME aftershade)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SECTION graphics)
set(CPACK_DEBIAN_RUNTIME_PACKAGE_DEPENDS ${gl_packages})
set(CPACK_DEBIAN_RUNTIME_PACKAGE_SUGGESTS libosmesa6)
set(CPACK_COMPONENT_RUNTIME_DESCRIPTION "Shader effects over G-buffer captures, without a display
 The program, its effects, manual pages and completions of shells.")

set(CPACK_DEBIAN_LIBRARY_PACKAGE_NAME ${library_package})
set(CPACK_DEBIAN_LIBRARY_PACKAGE_SECTION libs)
set(CPACK_DEBIAN_LIBRARY_PACKAGE_DEPENDS "aftershade (= ${PROJECT_VERSION})")
set(CPACK_COMPONENT_LIBRARY_DESCRIPTION "Shader effects over G-buffer captures: the library
 What programs that embed Aftershade load.")

set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_NAME libaftershade-dev)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SHLIBDEPS OFF)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS "${library_package} (= ${PROJECT_VERSION})")
set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "Shader effects over G-buffer captures: headers
 Headers of the library and of native plug-ins, with files for CMake and pkg-config.")

if(AFTERSHADE_PYTHON)
  list(APPEND CPACK_COMPONENTS_ALL python)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_NAME python3-aftershade)
  set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
  # An extension fits one minor version of Python.
  get_directory_property(python_minor DIRECTORY ${PROJECT_SOURCE_DIR}/python DEFINITION Python_VERSION_MINOR)
  math(EXPR next_minor "${python_minor} + 1")
  set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS
      "aftershade (= ${PROJECT_VERSION}), python3-numpy, python3 (>= 3.${python_minor}), python3 (<< 3.${next_minor})")
  set(CPACK_COMPONENT_PYTHON_DESCRIPTION "Shader effects over G-buffer captures: the Python module
 Looks, captures and comparisons with NumPy arrays.")
endif()
include(CPack)
