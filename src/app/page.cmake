# The page of the viewer: made by Vite from web/ and put into the program, compressed. Without Node the server says that it has no page.
set(web ${PROJECT_SOURCE_DIR}/web)
find_program(NODE node)
find_program(NPM npm)
if(EXISTS ${web}/package-lock.json AND NODE AND NPM)
    set(embedded ${CMAKE_BINARY_DIR}/page_files.cpp)
    file(GLOB_RECURSE page_sources CONFIGURE_DEPENDS ${web}/src/* ${web}/public/*)
    file(GLOB page_settings CONFIGURE_DEPENDS ${web}/*.json ${web}/*.ts ${web}/*.html)
    add_custom_command(OUTPUT ${CMAKE_BINARY_DIR}/page_modules
        COMMAND ${NPM} ci --no-audit --no-fund --loglevel=error
        COMMAND ${CMAKE_COMMAND} -E touch ${CMAKE_BINARY_DIR}/page_modules
        DEPENDS ${web}/package-lock.json WORKING_DIRECTORY ${web} COMMENT "Fetching the page's libraries" VERBATIM)
    add_custom_command(OUTPUT ${embedded}
        COMMAND ${NPM} run build --silent
        COMMAND ${NODE} ${PROJECT_SOURCE_DIR}/tools/embed_page.mjs ${web}/dist ${embedded}
        DEPENDS ${CMAKE_BINARY_DIR}/page_modules ${page_sources} ${page_settings} ${PROJECT_SOURCE_DIR}/tools/embed_page.mjs
            ${PROJECT_SOURCE_DIR}/docs/scene.schema.json ${PROJECT_SOURCE_DIR}/docs/protocol.schema.json
        WORKING_DIRECTORY ${web} COMMENT "Making the viewer's page" VERBATIM)
    list(FILTER sources EXCLUDE REGEX "no_page_files.cpp$")
    list(APPEND sources ${embedded})
else()
    message(STATUS "Node (node, npm) or web/ was not found: `crescente view` has no page, only its server")
endif()
