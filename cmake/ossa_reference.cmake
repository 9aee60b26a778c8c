# `cmake --build BUILD --target reference` writes the API reference of the public headers to
# BUILD/reference/html (Doxygen, docs/Doxyfile).
find_program(ossa_doxygen doxygen)
if(ossa_doxygen)
  add_custom_target(reference
    COMMAND ${CMAKE_COMMAND} -E make_directory ${PROJECT_BINARY_DIR}/reference
    COMMAND ${CMAKE_COMMAND} -E env OSSA_REFERENCE_DIR=${PROJECT_BINARY_DIR}/reference
            ${PROJECT_SOURCE_DIR}/tests/check_reference.py
    WORKING_DIRECTORY ${PROJECT_SOURCE_DIR} VERBATIM)
endif()
