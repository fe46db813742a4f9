/*
 * Refusals are one line that no terminal obeys, and an exit status.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#include <filesystem>

#include <gtest/gtest.h>

#include "tsr/host/input_error.h"

using namespace tsr;

namespace
{

/* What a program prints and returns that ends with the exception. */
template <typename Exception> std::pair<int, std::string> ends_with(const Exception &exception)
{
    testing::internal::CaptureStderr();
    const int status = run_program("program", [&]() -> int { throw exception; });
    return {status, testing::internal::GetCapturedStderr()};
}

TEST(InputError, WhatATerminalWouldObeyIsWrittenOut)
{
    EXPECT_STREQ(InputError("a\nb\x1b[31m", "f\t", "r\x7f").what(), "a\\x0ab\\x1b[31m: f\\x09: r\\x7f");
    EXPECT_STREQ(InputError("\u009b31m", "", "\u202edesrever\u2066").what(),
                 "\\xc2\\x9b31m: \\xe2\\x80\\xaedesrever\\xe2\\x81\\xa6");
    EXPECT_STREQ(InputError(std::string("a\0b", 3), "", "r").what(), "a\\x00b: r");
}

TEST(InputError, TextStays)
{
    for (const char *text :
         {"T\u00fcr", "\u20ac", "\u65e5\u672c", "\U0001f600", "\u00a0", "\u2027\u202f\u2065\u206a", "a\\b"}) {
        EXPECT_EQ(InputError(text, "", "r").what(), std::string(text) + ": r");
    }
}

TEST(InputError, WhatIsNotUtf8IsWrittenOut)
{
    EXPECT_STREQ(InputError("\xff\xc3", "", "\xc0\xaf").what(), "\\xff\\xc3: \\xc0\\xaf");
    EXPECT_STREQ(InputError("\xed\xa0\x80", "", "\xf4\x90\x80\x80").what(), "\\xed\\xa0\\x80: \\xf4\\x90\\x80\\x80");
    EXPECT_STREQ(InputError("\xe0\x80\x80", "", "\x9b").what(), "\\xe0\\x80\\x80: \\x9b");
}

TEST(RunProgram, TellsInputFromDefects)
{
    using Pair = std::pair<int, std::string>;
    EXPECT_EQ(ends_with(InputError("file", "field", "reason")), Pair(kExitInput, "program: file: field: reason\n"));
    EXPECT_EQ(ends_with(std::runtime_error("broken\n")), Pair(kExitInternal, "program: broken\\x0a\n"));
}

TEST(RunProgram, AFileSystemsErrorNamesItsPath)
{
    testing::internal::CaptureStderr();
    const int status =
        run_program("program", []() -> int { return static_cast<int>(std::filesystem::file_size("/nowhere\t/file")); });
    EXPECT_EQ(status, kExitInput);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "program: /nowhere\\x09/file: No such file or directory\n");
}

} // namespace
