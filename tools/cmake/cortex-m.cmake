# What the toolchain files of Cortex-M cores share; tsr_core_flags names the core. The C library is newlib for its memcpy
# and memset; nothing of it that allocates is linked.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_CXX_COMPILER arm-none-eabi-g++)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_EXECUTABLE_SUFFIX_C .elf)
set(CMAKE_C_FLAGS_INIT "${tsr_core_flags} -mthumb -mfloat-abi=hard -ffunction-sections -fdata-sections -fcallgraph-info=su")
set(CMAKE_C_FLAGS_RELEASE "-O3 -g -DNDEBUG" CACHE STRING "Flags of a release build")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-nostartfiles -Wl,--gc-sections -Wl,--fatal-warnings")
