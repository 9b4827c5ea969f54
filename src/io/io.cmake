# Libraries that read foreign formats. One that is missing, or switched off, switches off its formats: they are still listed and say why
# they cannot be read.
option(CRESCENTE_DRACO "Read glTF meshes compressed by Draco" ON)

if(CRESCENTE_ASSIMP)
    # Not by assimp's own configuration: on Debian it demands the development files of libraries that only assimp itself needs.
    find_path(ASSIMP_INCLUDE_DIR assimp/Importer.hpp)
    find_library(ASSIMP_LIBRARY assimp)
    if(ASSIMP_INCLUDE_DIR AND ASSIMP_LIBRARY)
        target_include_directories(io SYSTEM PRIVATE ${ASSIMP_INCLUDE_DIR})
        target_link_libraries(io PRIVATE ${ASSIMP_LIBRARY})
        target_compile_definitions(io PRIVATE CRESCENTE_WITH_ASSIMP)
    else()
        message(STATUS "Assimp was not found: OBJ, PLY, STL and the other mesh formats are switched off")
    endif()
endif()

if(CRESCENTE_DRACO)
    find_path(DRACO_INCLUDE_DIR draco/compression/decode.h)
    find_library(DRACO_LIBRARY draco)
    if(DRACO_INCLUDE_DIR AND DRACO_LIBRARY)
        target_include_directories(io SYSTEM PRIVATE ${DRACO_INCLUDE_DIR})
        target_link_libraries(io PRIVATE ${DRACO_LIBRARY})
        target_compile_definitions(io PRIVATE CRESCENTE_WITH_DRACO)
    else()
        message(STATUS "Draco was not found: compressed glTF meshes are switched off")
    endif()
endif()

include(io/cad.cmake OPTIONAL)
include(io/image.cmake OPTIONAL)
