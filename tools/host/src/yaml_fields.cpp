/* YAML by yaml-cpp. SPDX-License-Identifier: Apache-2.0 */
#include "yaml_fields.h"

#include <cmath>
#include <limits>
#include <utility>

#include "tsr/host/input_error.h"

namespace tsr
{
namespace
{

constexpr std::size_t kValuesMax = 64;

/* "%YAML:1.0" is no YAML directive: it becomes a comment of the same length. */
std::string plain_yaml(std::string_view text)
{
    std::string plain(text);
    if (plain.starts_with("%YAML:")) {
        plain[0] = '#';
    }
    return plain;
}

bool is_matrix_map(const YAML::Node &node)
{
    return node.IsMap() && node["rows"] && node["cols"] && node["data"];
}

} // namespace

YamlFields::YamlFields(std::string_view text, std::string file) : file_(std::move(file))
{
    try {
        node_ = YAML::Load(plain_yaml(text));
    } catch (const YAML::Exception &error) {
        const std::string at = error.mark.is_null() ? "" : ":" + std::to_string(error.mark.line + 1);
        throw InputError(file_ + at, "", "is no YAML: " + error.msg);
    }
    if (!node_.IsMap()) {
        throw InputError(file_, "", "holds no fields");
    }
}

std::string YamlFields::where(const YAML::Node &node) const
{
    return node.Mark().is_null() ? file_ : file_ + ":" + std::to_string(node.Mark().line + 1);
}

YAML::Node YamlFields::find(Names names) const
{
    for (const char *name : names) {
        const YAML::Node node = node_[name];
        if (node.IsDefined() && !node.IsNull()) {
            return node;
        }
    }
    return YAML::Node(YAML::NodeType::Null);
}

YAML::Node YamlFields::required(Names names) const
{
    const YAML::Node node = find(names);
    if (node.IsNull()) {
        throw InputError(file_, *names.begin(), "is missing");
    }
    return node;
}

bool YamlFields::has(Names names) const
{
    return !find(names).IsNull();
}

void YamlFields::refuse(Names names, const std::string &reason) const
{
    for (const char *name : names) {
        if (const YAML::Node node = node_[name]; node.IsDefined()) {
            throw InputError(where(node), name, reason);
        }
    }
    throw InputError(file_, *names.begin(), reason);
}

double YamlFields::number(Names names) const
{
    const YAML::Node node = required(names);
    double value = 0;
    if (!node.IsScalar() || !YAML::convert<double>::decode(node, value) || !std::isfinite(value)) {
        refuse(names, "is not a finite number");
    }
    return value;
}

int YamlFields::integer(Names names) const
{
    const double value = number(names);
    if (value != std::floor(value) || std::abs(value) > std::numeric_limits<int>::max()) {
        refuse(names, "is not a whole number");
    }
    return static_cast<int>(value);
}

std::string YamlFields::text(Names names) const
{
    const YAML::Node node = required(names);
    if (!node.IsScalar()) {
        refuse(names, "is not a word");
    }
    return node.Scalar();
}

YamlFields YamlFields::map(Names names) const
{
    const YAML::Node node = required(names);
    if (!node.IsMap()) {
        refuse(names, "is not a table of fields");
    }
    return {node, file_};
}

YamlMatrix YamlFields::matrix(Names names) const
{
    const YAML::Node node = required(names);
    YamlMatrix matrix;
    YAML::Node data = node;
    for (const char *name : names) {
        if (node_[name].IsDefined() && !node_[name].IsNull()) {
            matrix.name = name;
            break;
        }
    }
    matrix.where = where(node);
    if (is_matrix_map(node)) {
        const YamlFields fields(node, file_);
        matrix.rows = fields.integer({"rows"});
        matrix.cols = fields.integer({"cols"});
        data.reset(node["data"]);
    }
    if (!data.IsSequence() || data.size() == 0 || data.size() > kValuesMax) {
        throw InputError(matrix.where, matrix.name, "is no matrix of numbers");
    }
    const bool nested = data[0].IsSequence();
    for (const YAML::Node &row : data) {
        if (row.IsSequence() != nested || (nested && row.size() != data[0].size())) {
            throw InputError(matrix.where, matrix.name, "has rows of different lengths");
        }
        for (std::size_t i = 0; i < (nested ? row.size() : 1); i++) {
            const YAML::Node &item = nested ? row[i] : row;
            double value = 0;
            if (!item.IsScalar() || !YAML::convert<double>::decode(item, value) || !std::isfinite(value)) {
                throw InputError(where(item), matrix.name, "holds something that is not a finite number");
            }
            matrix.values.push_back(value);
        }
    }
    if (!is_matrix_map(node)) {
        matrix.rows = nested ? static_cast<int>(data.size()) : 1;
        matrix.cols = static_cast<int>(matrix.values.size()) / matrix.rows;
    }
    if (matrix.rows < 1 || matrix.cols < 1 ||
        static_cast<std::int64_t>(matrix.rows) * matrix.cols != static_cast<std::int64_t>(matrix.values.size())) {
        throw InputError(matrix.where, matrix.name,
                         "has " + std::to_string(matrix.values.size()) + " values for " + std::to_string(matrix.rows) +
                             " rows of " + std::to_string(matrix.cols));
    }
    return matrix;
}

} // namespace tsr
