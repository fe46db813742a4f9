# Cortex-M4F, as on QEMU's mps2-an386 and most 802.15.4 parts.
set(CMAKE_SYSTEM_PROCESSOR cortex-m4)
set(tsr_core_flags "-mcpu=cortex-m4 -mfpu=fpv4-sp-d16")
set(TSR_BOARD mps2-an386)
include(${CMAKE_CURRENT_LIST_DIR}/cortex-m.cmake)
