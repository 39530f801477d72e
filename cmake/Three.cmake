# three.js plays the animation of a report inside its page (Debian: libjs-three).
find_file(THREE_JS three.min.js PATHS /usr/share/javascript/three NO_DEFAULT_PATH)
find_file(THREE_ORBIT_JS OrbitControls.js PATHS /usr/share/javascript/three/examples/js/controls NO_DEFAULT_PATH)
if(NOT THREE_JS OR NOT THREE_ORBIT_JS)
  message(STATUS "no three.js (Debian: libjs-three): reports will show a still picture of the mill")
  file(WRITE ${CMAKE_BINARY_DIR}/no-three.js "")
  set(THREE_JS ${CMAKE_BINARY_DIR}/no-three.js)
  set(THREE_ORBIT_JS ${CMAKE_BINARY_DIR}/no-three.js)
endif()
