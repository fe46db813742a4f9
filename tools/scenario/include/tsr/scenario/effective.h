/*
 * The scenario that was run, --set and --seed included, as a file that runs it again.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENARIO_EFFECTIVE_H
#define TSR_SCENARIO_EFFECTIVE_H

#include <filesystem>
#include <string>
#include <vector>

#include <toml++/toml.h>

namespace tsr
{

class EffectiveScenario
{
  public:
    /* As load_scenario() has it, which has accepted both. Throws InputError. */
    EffectiveScenario(const std::filesystem::path &file, const std::vector<std::string> &settings);

    /* scenario.toml for a folder: a relative path in it is relative to that folder. */
    std::string text_for(const std::filesystem::path &folder) const;

  private:
    std::filesystem::path file_;
    toml::table table_;
};

/* A setting without the folders of this machine: of an absolute path its file's name is left. */
std::string without_folders(const std::string &setting);

} // namespace tsr

#endif
