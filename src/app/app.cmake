# The command line program.
file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_LIST_DIR}/cli/*.cpp)
add_executable(crescente ${sources})
target_compile_definitions(crescente PRIVATE CRESCENTE_VERSION="${PROJECT_VERSION}")
target_link_libraries(crescente PRIVATE render io scene geometry math base CLI11::CLI11 spdlog::spdlog nlohmann_json::nlohmann_json)
