# find_package(cylwatch) gives cylwatch::cylwatch (static) and cylwatch::shared.
get_filename_component(_cylwatch_prefix "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
find_package(Threads REQUIRED)

if(NOT TARGET cylwatch::cylwatch)
    add_library(cylwatch::cylwatch STATIC IMPORTED)
    set_target_properties(cylwatch::cylwatch PROPERTIES
        IMPORTED_LOCATION "${_cylwatch_prefix}/lib/libcylwatch_c.a"
        INTERFACE_INCLUDE_DIRECTORIES "${_cylwatch_prefix}/include"
        INTERFACE_LINK_LIBRARIES "Threads::Threads;${CMAKE_DL_LIBS};m;gcc_s")
    add_library(cylwatch::shared SHARED IMPORTED)
    set_target_properties(cylwatch::shared PROPERTIES
        IMPORTED_LOCATION "${_cylwatch_prefix}/lib/libcylwatch_c.so"
        IMPORTED_NO_SONAME ON
        INTERFACE_INCLUDE_DIRECTORIES "${_cylwatch_prefix}/include")
endif()
