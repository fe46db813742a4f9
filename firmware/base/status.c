/*
 * Names of the status codes, for logs.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include "tsr/base/status.h"

const char *tsr_status_name(enum tsr_status status)
{
    switch (status) {
    case TSR_AGAIN: return "again";
    case TSR_OK: return "ok";
    case TSR_ERR_ARG: return "arg";
    case TSR_ERR_NOBUF: return "nobuf";
    case TSR_ERR_SIZE: return "size";
    case TSR_ERR_FORMAT: return "format";
    case TSR_ERR_VERSION: return "version";
    case TSR_ERR_AUTH: return "auth";
    case TSR_ERR_REPLAY: return "replay";
    case TSR_ERR_BUSY: return "busy";
    case TSR_ERR_TIMEOUT: return "timeout";
    case TSR_ERR_IO: return "io";
    case TSR_ERR_NOKEY: return "nokey";
    case TSR_ERR_NOROUTE: return "noroute";
    case TSR_ERR_NOREF: return "noref";
    }
    return "unknown";
}
