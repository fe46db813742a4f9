# Mbed TLS's AES block alone, as boards have it, without the warnings that are ours to keep.
set(MBEDTLS_DIR "$ENV{MBEDTLS_DIR}" CACHE PATH "Folder of Mbed TLS 2.28's sources, with library/aes.c")
if(NOT MBEDTLS_DIR)
    set(MBEDTLS_DIR ${CMAKE_SOURCE_DIR}/.deps/mbedtls)
endif()
if(NOT EXISTS ${MBEDTLS_DIR}/library/aes.c)
    message(FATAL_ERROR "MBEDTLS_DIR ${MBEDTLS_DIR}: no library/aes.c there; run tools/setup test")
endif()

add_library(tsr_mbedtls_aes STATIC ${MBEDTLS_DIR}/library/aes.c ${MBEDTLS_DIR}/library/platform_util.c)
target_include_directories(tsr_mbedtls_aes SYSTEM PUBLIC ${MBEDTLS_DIR}/include PRIVATE ${MBEDTLS_DIR}/library)
target_include_directories(tsr_mbedtls_aes PUBLIC ${CMAKE_CURRENT_LIST_DIR}/config)
target_compile_definitions(tsr_mbedtls_aes PUBLIC MBEDTLS_CONFIG_FILE="tsr_mbedtls_config.h")
target_compile_options(tsr_mbedtls_aes PRIVATE -O2) # -O3 takes 1 KB of flash for 1 % of the work
