/*
 * The files a command writes: refused before anything is read where they would
 * destroy an input or each other, and written together or not at all.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_OUTPUT_FILES_H
#define TSR_HOST_OUTPUT_FILES_H

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace tsr
{

/* An output and the option that names it. */
struct OutputFile {
    std::filesystem::path file;
    const char *option;
};

/* Throws InputError naming an output that is one of the inputs, or the same file as an output before it, and as
 * real_path() does. */
void check_outputs(const std::vector<OutputFile> &outputs, const std::vector<std::filesystem::path> &inputs);

/* For CLI::Option::check(): an option that was given names something. */
std::string refuse_empty_name(const std::string &name);

/* A file that was written and is removed again unless what belongs to it is written too. */
class EarlierOutput
{
  public:
    explicit EarlierOutput(std::filesystem::path file) : file_(std::move(file)) {}
    EarlierOutput(const EarlierOutput &) = delete;
    EarlierOutput &operator=(const EarlierOutput &) = delete;
    ~EarlierOutput();

    void keep() { file_.clear(); }

  private:
    std::filesystem::path file_; /* empty: none, or kept */
};

} // namespace tsr

#endif
