/*
 * A folder that grows under another name, NAME.partial beside it, and gets its own when it is complete.
 *
 * A file tarsier-render marks the partial folder as ours and is locked while it grows. What a render left that was
 * killed is removed; a NAME.partial without the mark is somebody's own and is refused.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_SCENARIO_PARTIAL_FOLDER_H
#define TSR_SCENARIO_PARTIAL_FOLDER_H

#include <filesystem>

namespace tsr
{

class PartialFolder
{
  public:
    /* out must not exist or be an empty folder that its name can be taken from: neither the working folder nor a
     * mount point. Throws InputError. */
    explicit PartialFolder(const std::filesystem::path &out);
    ~PartialFolder(); /* without keep(): removes what has grown */
    PartialFolder(const PartialFolder &) = delete;
    PartialFolder &operator=(const PartialFolder &) = delete;

    const std::filesystem::path &path() const { return folder_; }
    /* With the folders above. Throws InputError. */
    static void make(const std::filesystem::path &folder);
    /* It is there under its name. Throws InputError. */
    void keep();

  private:
    void claim();

    std::filesystem::path out_;
    std::filesystem::path folder_;
    int lock_ = -1;
    bool kept_ = false;
};

} // namespace tsr

#endif
