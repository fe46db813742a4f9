/*
 * Typed access to YAML calibrations by the names that different programs give
 * one field. Errors are InputErrors "file:line: field: reason".
 *
 * SPDX-License-Identifier: Apache-2.0
 */
#ifndef TSR_HOST_YAML_FIELDS_H
#define TSR_HOST_YAML_FIELDS_H

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include <yaml-cpp/yaml.h>

namespace tsr
{

using Names = std::initializer_list<const char *>;

struct YamlMatrix {
    int rows = 0;
    int cols = 0;
    std::vector<double> values; /* row-major, finite */
    std::string where;          /* "file:line" */
    std::string name;
};

class YamlFields
{
  public:
    /* Parses text; cv::FileStorage's own first line is understood. */
    YamlFields(std::string_view text, std::string file);
    YamlFields(const YAML::Node &node, std::string file) : node_(node), file_(std::move(file)) {}

    const std::string &file() const { return file_; }
    bool has(Names names) const;
    double number(Names names) const;
    int integer(Names names) const;
    std::string text(Names names) const;
    /* {rows, cols, data}, a list of rows, or a plain list (one row). */
    YamlMatrix matrix(Names names) const;
    YamlFields map(Names names) const;
    [[noreturn]] void refuse(Names names, const std::string &reason) const;

  private:
    YAML::Node find(Names names) const; /* null node if absent */
    YAML::Node required(Names names) const;
    std::string where(const YAML::Node &node) const;

    YAML::Node node_;
    std::string file_;
};

} // namespace tsr

#endif
