# Headers of libraries cost more to compile than most sources that include them. A build that checks memory, by far the
# slowest, reads them once for the host's libraries and once for the tests. Other builds do not: there a source that
# misses an include does not compile, and GCC 12 forgets which of what it precompiled are system headers, so that
# -Wstringop-overflow misfires in them at -O3.
if(NOT TSR_ASAN)
    set(CMAKE_DISABLE_PRECOMPILE_HEADERS ON)
endif()

set(TSR_PRECOMPILED_HEADERS <algorithm> <filesystem> <functional> <map> <memory> <optional> <set> <span> <sstream>
    <stdexcept> <string> <vector> <Eigen/Dense>)

# For a static library that links tsr_host.
function(tsr_use_precompiled_headers library)
    target_precompile_headers(${library} REUSE_FROM tsr_host)
endfunction()
