/*
 * The one way host code refuses input: an exception whose what() is one line,
 * "file: field: reason". Mains turn it into that line on stderr and exit
 * status 2, so that bad input always reads the same.
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_INPUT_ERROR_H
#define TSR_HOST_INPUT_ERROR_H

#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace tsr
{

inline constexpr int kExitInternal = 1; /* a defect or an exhausted machine */
inline constexpr int kExitInput = 2;    /* the caller's input is refused */

/* Control characters and what is not UTF-8, which a file or its name can smuggle into a line, are printed as \xNN. */
class InputError : public std::runtime_error
{
  public:
    /* field may be empty: then what() is "file: reason". */
    InputError(std::string file, std::string field, std::string reason);

    const std::string &file() const { return file_; }
    const std::string &field() const { return field_; }
    const std::string &reason() const { return reason_; }

  private:
    std::string file_;
    std::string field_;
    std::string reason_;
};

/*
 * The body of a main(): its result is the exit status; an InputError prints
 * "program: file: field: reason" and gives kExitInput, so does a file system's
 * error with the path it names, and any other exception prints its text and
 * gives kExitInternal.
 */
int run_program(std::string_view program, const std::function<int()> &body);

} // namespace tsr

#endif
