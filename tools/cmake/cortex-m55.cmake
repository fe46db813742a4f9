# Cortex-M55 with MVE (Helium), as on QEMU's mps3-an547.
set(CMAKE_SYSTEM_PROCESSOR cortex-m55)
set(tsr_core_flags "-mcpu=cortex-m55")
set(TSR_BOARD mps3-an547)
include(${CMAKE_CURRENT_LIST_DIR}/cortex-m.cmake)
