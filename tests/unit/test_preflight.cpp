/*
 * What a run needs is known before it begins.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <gtest/gtest.h>

#include "test_host_folder.h"
#include "tsr/emulator/preflight.h"
#include "tsr/emulator/scene_pictures.h"

using namespace tsr;
using namespace tsr::test;

namespace
{

TEST(Preflight, ARunThatNeedsMoreMemoryThanThereIsIsRefused)
{
    const Folder folder;
    const auto file =
        folder.put("scenario.toml", "name = \"t\"\n[scene]\nkind = \"tank\"\n[pairs]\ncount = 100\nwidth = 640\n"
                                    "height = 480\n");
    const Staging staging = stage_scenario(load_scenario(file, {}));
    const std::uint64_t nodes = check_nodes(staging.site, derive_test_keys(1, staging.site));
    EXPECT_GT(nodes, 100u * 640 * 480) << "each holds a picture at least";
    const std::uint64_t seen = ScenePictures::memory(staging);
    /* Four rays of three floats, a point and three layers of light for each pixel, and whether it is to be traced. */
    EXPECT_EQ(seen, 200u * 640 * 480 * (48 + 8 + 12 + 1));
    EXPECT_NO_THROW(check_memory(staging.site, file, nodes + seen, nodes + seen));
    EXPECT_REFUSED(
        check_memory(staging.site, file, 4'250'000'000, 4'000'000'000),
        "scenario.toml: pairs: 100 pairs need 4.3 GB of memory for their nodes and what their cameras see, and "
        "there are 4.0 GB");
    EXPECT_GT(memory_there(), 1u << 28);
}

} // namespace
