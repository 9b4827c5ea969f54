# Flags for all of our own code.
add_library(crescente_flags INTERFACE)
target_include_directories(crescente_flags INTERFACE ${PROJECT_SOURCE_DIR}/src)
target_compile_options(crescente_flags INTERFACE
    -Wall -Wextra -Wshadow -Wnon-virtual-dtor
    -march=${CRESCENTE_ARCH}
    # GCC 12 warns without cause in inlined std::string operations (GCC bug 105651).
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
    # No fused multiply-adds of the compiler's choosing: the same expression must give the same bits in scalar and vector code, in
    # every file and on every machine. Nothing here reads errno of math functions or the floating-point traps.
    -ffp-contract=off -fno-math-errno -fno-trapping-math)
if(CRESCENTE_SANITIZE)
    target_compile_options(crescente_flags INTERFACE -fsanitize=${CRESCENTE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
    target_link_options(crescente_flags INTERFACE -fsanitize=${CRESCENTE_SANITIZE})
endif()
find_program(MOLD mold)
if(MOLD AND NOT CRESCENTE_SANITIZE)
    target_link_options(crescente_flags INTERFACE -fuse-ld=mold)
endif()
find_program(CCACHE ccache)
if(CCACHE)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE})
endif()
