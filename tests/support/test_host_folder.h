/*
 * A folder that lives as long as a test, and the text of an InputError.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_TEST_HOST_FOLDER_H
#define TSR_TEST_HOST_FOLDER_H

#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "tsr/host/input_error.h"

namespace tsr::test
{

class Folder
{
  public:
    Folder()
    {
        std::string pattern = (std::filesystem::temp_directory_path() / "tsr-test-XXXXXX").string();
        if (::mkdtemp(pattern.data()) == nullptr) {
            throw std::runtime_error("mkdtemp failed");
        }
        path_ = pattern;
    }
    Folder(const Folder &) = delete;
    Folder &operator=(const Folder &) = delete;
    ~Folder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }

    const std::filesystem::path &path() const { return path_; }
    std::filesystem::path operator/(const std::string &name) const { return path_ / name; }

    std::filesystem::path put(const std::string &name, const std::string &bytes) const
    {
        const std::filesystem::path file = path_ / name;
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file, std::ios::binary) << bytes;
        return file;
    }

  private:
    std::filesystem::path path_;
};

inline std::string read_all(const std::filesystem::path &file)
{
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

/* The one line of the InputError that action throws; "" if it throws none. */
template <typename Action> std::string refusal(Action action)
{
    try {
        action();
    } catch (const InputError &error) {
        return error.what();
    }
    return "";
}

} // namespace tsr::test

/* The refusal of an expression contains text, and is one line. */
#define EXPECT_REFUSED(expression, text)                                                                               \
    do {                                                                                                               \
        const std::string what_ = tsr::test::refusal([&] { (void)(expression); });                                     \
        EXPECT_NE(what_.find(text), std::string::npos) << "refusal: \"" << what_ << "\"";                              \
        EXPECT_EQ(what_.find('\n'), std::string::npos);                                                                \
    } while (false)

#endif
