/* Tables of records. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/emulator/table.h"

#include <algorithm>
#include <iterator>

#include "tsr/emulator/record_json.h"
#include "tsr/host/csv.h"

namespace tsr
{

namespace
{

using Json = nlohmann::ordered_json;

/* What differs from node to node in its keys has no columns. */
constexpr const char *kNoColumns = "work";

/* The leaves of an example that has them all. */
void find_leaves(const Json &example, const Json::json_pointer &path, std::vector<Json::json_pointer> &leaves)
{
    for (const auto &[key, value] : example.items()) {
        if (value.is_object() && key != kNoColumns) {
            find_leaves(value, path / key, leaves);
        } else if (!value.is_object()) {
            leaves.push_back(path / key);
        }
    }
}

std::string column_of(const Json::json_pointer &leaf)
{
    std::string name = leaf.to_string().substr(1);
    std::replace(name.begin(), name.end(), '/', '_');
    return name;
}

template <typename Record> Table table_of(const Record &example, const std::vector<Record> &records)
{
    std::vector<Json::json_pointer> leaves;
    find_leaves(json_of(example), Json::json_pointer(), leaves);
    Table table;
    std::transform(leaves.begin(), leaves.end(), std::back_inserter(table.columns), column_of);
    for (const Record &record : records) {
        const Json json = json_of(record);
        std::vector<Json> &row = table.rows.emplace_back();
        row.reserve(leaves.size());
        for (const auto &leaf : leaves) {
            row.push_back(json.contains(leaf) ? json.at(leaf) : Json());
        }
    }
    return table;
}

std::string cell_of(const Json &value)
{
    return value.is_null() ? "" : value.is_string() ? csv_field(value.get<std::string>()) : value.dump();
}

} // namespace

Table nodes_table(const RunRecord &run)
{
    return table_of(NodeRecord{}, run.nodes);
}

Table links_table(const RunRecord &run)
{
    return table_of(LinkRecord{}, run.links);
}

Table maps_table(const RunRecord &run)
{
    ReceivedMap example;
    example.error = MapError{};
    return table_of(example, run.maps);
}

std::string csv_of(const Table &table)
{
    std::string text;
    const auto add_line = [&text](const auto &cells, const auto &print) {
        for (std::size_t i = 0; i < cells.size(); ++i) {
            text += (i > 0 ? "," : "") + print(cells[i]);
        }
        text += '\n';
    };
    add_line(table.columns, csv_field);
    for (const auto &row : table.rows) {
        add_line(row, cell_of);
    }
    return text;
}

} // namespace tsr
