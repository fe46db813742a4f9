/*
 * Opening what --listen names.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SINK_ENDPOINTS_H
#define TSR_SINK_ENDPOINTS_H

#include <string>

#include "descriptor.h"
#include "tsr/sink/listen_address.h"

namespace tsr
{

/* A listening socket (Unix or TCP), non-blocking. A Unix socket left behind by
 * a sink that died is replaced; one that is in use is refused. Throws InputError. */
Descriptor open_listener(const ListenAddress &address);

/* A link that is there from the start: a serial port, raw, or the inherited
 * socket; non-blocking. Throws InputError. */
Descriptor open_link(const ListenAddress &address);

} // namespace tsr

#endif
