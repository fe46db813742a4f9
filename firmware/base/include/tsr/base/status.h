/*
 * Status codes: one enum for every function of the firmware and the HAL.
 *
 * Zero is success, negative values are errors, TSR_AGAIN is "not yet": the
 * work is unfinished and the same call continues it. On an error the outputs
 * are untouched unless the function's contract says otherwise.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_BASE_STATUS_H
#define TSR_BASE_STATUS_H

enum tsr_status {
    TSR_AGAIN = 1, /* resumable work is not finished */
    TSR_OK = 0,
    TSR_ERR_ARG = -1,      /* null pointer, value out of its documented range */
    TSR_ERR_NOBUF = -2,    /* a caller's buffer or queue is too small */
    TSR_ERR_SIZE = -3,     /* shapes that do not fit each other */
    TSR_ERR_FORMAT = -4,   /* bytes that do not follow their format */
    TSR_ERR_VERSION = -5,  /* a format version this build does not know */
    TSR_ERR_AUTH = -6,     /* message integrity code does not verify */
    TSR_ERR_REPLAY = -7,   /* authentic but not newer than the last accepted */
    TSR_ERR_BUSY = -8,     /* the object is in use by earlier work */
    TSR_ERR_TIMEOUT = -9,  /* no answer in the documented time */
    TSR_ERR_IO = -10,      /* the device or the file failed */
    TSR_ERR_NOKEY = -11,   /* no key for this source or key identifier */
    TSR_ERR_NOROUTE = -12, /* no next hop to this destination */
    TSR_ERR_NOREF = -13    /* what these bytes refer to is not what is held here */
};

/* The name of a status without its prefix, for logs: "ok", "auth", ...
 * Unknown values give "unknown". The string is static. */
const char *tsr_status_name(enum tsr_status status);

#endif
