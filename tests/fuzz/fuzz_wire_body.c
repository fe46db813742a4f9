/*
 * Any bytes as the body of each kind of message, and as a message's header.
 *
 *   tools/fuzz wire_body
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "tsr/wire/body.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len);

static void require_body(int condition)
{
    if (!condition) {
        abort();
    }
}

static void try_map(const uint8_t *bytes, size_t len)
{
    struct tsr_body_map map;
    uint8_t header[TSR_BODY_MAP_HEADER_LEN];
    if (tsr_body_read_map(bytes, len, &map) != TSR_OK) {
        return;
    }
    require_body(map.map_len > 0 && TSR_BODY_MAP_HEADER_LEN + map.reference_len + map.map_len == len);
    require_body(map.map == bytes + TSR_BODY_MAP_HEADER_LEN + map.reference_len);
    require_body((map.reference == NULL) == (map.reference_len == 0));
    tsr_body_write_map_header(map.capture_time_us, map.capture_id, map.reference_len, header);
    require_body(memcmp(header, bytes, sizeof header) == 0);
}

static void try_status(const uint8_t *bytes, size_t len)
{
    struct tsr_body_status status;
    uint8_t again[TSR_BODY_STATUS_MAX];
    size_t again_len = 0;
    if (tsr_body_read_status(bytes, len, &status) != TSR_OK) {
        return;
    }
    require_body(tsr_body_write_status(&status, again, sizeof again, &again_len) == TSR_OK);
    require_body(again_len == len && memcmp(again, bytes, len) == 0);
}

static void try_events(const uint8_t *bytes, size_t len)
{
    struct tsr_body_events events;
    uint8_t again[TSR_BODY_EVENT_HEADER_LEN + TSR_BODY_EVENTS_MAX * TSR_BODY_EVENT_LEN];
    size_t again_len = 0;
    if (tsr_body_read_events(bytes, len, &events) != TSR_OK) {
        return;
    }
    require_body(tsr_body_write_events(&events, again, sizeof again, &again_len) == TSR_OK);
    require_body(again_len == len && memcmp(again, bytes, len) == 0);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t len)
{
    struct tsr_body_capture capture;
    struct tsr_message_header header;
    uint8_t again[TSR_BODY_WAKE_LEN];
    if (tsr_body_read_capture(bytes, len, &capture) == TSR_OK) {
        tsr_body_write_capture(&capture, again);
        require_body(memcmp(again, bytes, sizeof again) == 0);
    } else {
        require_body(len < TSR_BODY_WAKE_LEN);
    }
    try_map(bytes, len);
    try_events(bytes, len);
    try_status(bytes, len);
    if (tsr_message_parse(bytes, len, 3, 0, &header) == TSR_OK) {
        require_body(len >= TSR_MESSAGE_OVERHEAD_LEN && header.origin == 3 && header.destination == 0);
        require_body(header.kind == bytes[0] && header.key_use == bytes[1]);
    }
    return 0;
}
