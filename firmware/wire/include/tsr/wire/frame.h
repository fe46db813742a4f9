/*
 * IEEE 802.15.4 data frames with frame security, and their acknowledgements.
 *
 *   octets  2    1     2     2      2       1        4        1      0..102  8    2
 *          FCF  seq  PAN   dest  source | control  counter  key  | payload MIC | FCS
 *          `------- MHR, 9 --------'     `- auxiliary, 6 -'
 *
 * Frame version 1 (IEEE 802.15.4-2006), PAN-id compression, short addresses,
 * security level 6 (ENC-MIC-64), key identifier mode 1 with key index 1 (the
 * site's link key). IEEE 802.15.4-2015, 7.2 (MHR), 9.4 (auxiliary header),
 * 9.3.3.1 (nonce: source EUI-64, frame counter, security level).
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_WIRE_FRAME_H
#define TSR_WIRE_FRAME_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "tsr/wire/ccm.h"

#define TSR_FRAME_PSDU_MAX 127u  /* aMaxPhyPacketSize, IEEE 802.15.4-2015, Table 11-1 */
#define TSR_FRAME_HEADER_LEN 15u /* MHR and auxiliary security header */
#define TSR_FRAME_FCS_LEN 2u
#define TSR_FRAME_OVERHEAD_LEN (TSR_FRAME_HEADER_LEN + TSR_CCM_TAG_LEN + TSR_FRAME_FCS_LEN)
#define TSR_FRAME_PAYLOAD_MAX (TSR_FRAME_PSDU_MAX - TSR_FRAME_OVERHEAD_LEN)
#define TSR_FRAME_ACK_LEN 5u

struct tsr_frame_header {
    uint8_t sequence; /* data sequence number, answered by the acknowledgement */
    bool ack_request; /* the receiver's radio acknowledges at once */
    uint16_t pan_id;
    uint16_t destination; /* short address or TSR_ADDRESS_BROADCAST */
    uint16_t source;      /* short address */
    uint32_t counter;     /* frame counter; 0xffffffff is refused (9.4.2.3: key worn out) */
};

/*
 * Build and seal a frame.
 *
 *   payload  [payload_len] in, 0..TSR_FRAME_PAYLOAD_MAX
 *   psdu     [psdu_cap] out, the frame with its FCS; *psdu_len bytes filled
 *
 * TSR_ERR_ARG: payload too long or counter exhausted; TSR_ERR_NOBUF: psdu_cap
 * too small; TSR_ERR_IO from the cipher. psdu is unspecified then.
 */
enum tsr_status tsr_frame_seal(const struct tsr_frame_header *header, const struct tsr_cipher *link_cipher,
                               const uint8_t *payload, size_t payload_len, uint8_t *psdu, size_t psdu_cap,
                               size_t *psdu_len);

/*
 * Read the header of a received PSDU and check its FCS; nothing is decrypted.
 * TSR_ERR_FORMAT: not one of our secured data frames or a wrong FCS.
 */
enum tsr_status tsr_frame_parse(const uint8_t *psdu, size_t psdu_len, struct tsr_frame_header *header);

/*
 * Check and decrypt a frame that tsr_frame_parse accepted.
 *
 *   payload  [payload_cap] out, *payload_len bytes filled
 *
 * TSR_ERR_AUTH: wrong MIC, payload zeroed; TSR_ERR_NOBUF; TSR_ERR_FORMAT.
 */
enum tsr_status tsr_frame_open(const uint8_t *psdu, size_t psdu_len, const struct tsr_cipher *link_cipher,
                               uint8_t *payload, size_t payload_cap, size_t *payload_len);

/* Immediate acknowledgement of the frame with this sequence number
 * (IEEE 802.15.4-2015, 7.3.3). It carries no address and no MIC: whoever
 * hears a frame can forge its acknowledgement. */
void tsr_frame_write_ack(uint8_t sequence, uint8_t psdu[TSR_FRAME_ACK_LEN]);

/* Whether psdu is an acknowledgement with a correct FCS; gives its sequence number. */
bool tsr_frame_is_ack(const uint8_t *psdu, size_t psdu_len, uint8_t *sequence);

#endif
