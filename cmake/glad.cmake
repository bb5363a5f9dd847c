# The GL and EGL loader, generated offline by Debian's glad 2 as one table per context (--mx): nothing about GL is
# global. AFTERSHADE_GLAD_DIR takes a generated one where glad is absent.
set(GLAD_DIR ${AFTERSHADE_GLAD_DIR})
if(NOT GLAD_DIR)
  set(GLAD_DIR ${PROJECT_BINARY_DIR}/glad)
  if(NOT EXISTS ${GLAD_DIR}/src/egl.c)
    execute_process(
      COMMAND /usr/bin/python3 /usr/bin/glad --quiet --reproducible --out-path ${GLAD_DIR}
              --api gl:core=4.5,egl=1.5
              --extensions GL_KHR_debug,EGL_EXT_platform_base,EGL_EXT_platform_device,EGL_EXT_device_base,EGL_EXT_device_query,EGL_EXT_device_enumeration,EGL_MESA_platform_surfaceless,EGL_KHR_surfaceless_context,EGL_KHR_no_config_context,EGL_EXT_client_extensions
              c --mx
      RESULT_VARIABLE GLAD_RESULT ERROR_VARIABLE GLAD_ERROR)
    if(NOT GLAD_RESULT EQUAL 0)
      message(FATAL_ERROR "/usr/bin/glad failed (install python3-glad, or set AFTERSHADE_GLAD_DIR):\n${GLAD_ERROR}")
    endif()
  endif()
endif()
add_library(glad STATIC ${GLAD_DIR}/src/gl.c ${GLAD_DIR}/src/egl.c)
target_include_directories(glad SYSTEM PUBLIC ${GLAD_DIR}/include)
target_link_libraries(glad PUBLIC ${CMAKE_DL_LIBS})
