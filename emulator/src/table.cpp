/* Tables of records. SPDX-License-Identifier: Apache-2.0 */
#include "tsr/emulator/table.h"

#include "tsr/emulator/record_json.h"

namespace tsr
{

namespace
{

using Json = nlohmann::ordered_json;

/* What differs from node to node in its keys has no columns. */
constexpr const char *kNoColumns = "work";

/* Columns are the leaves of an example that has them all; a path is a JSON pointer. */
void find_leaves(const Json &example, const std::string &path, const std::string &name, Table &table,
                 std::vector<Json::json_pointer> &paths)
{
    for (const auto &[key, value] : example.items()) {
        const std::string column = name.empty() ? key : name + "_" + key;
        if (key == kNoColumns) {
            continue;
        }
        if (value.is_object()) {
            find_leaves(value, path + "/" + key, column, table, paths);
        } else {
            table.columns.push_back(column);
            paths.emplace_back(path + "/" + key);
        }
    }
}

template <typename Record> Table table_of(const Record &example, const std::vector<Record> &records)
{
    Table table;
    std::vector<Json::json_pointer> paths;
    find_leaves(json_of(example), "", "", table, paths);
    for (const Record &record : records) {
        const Json json = json_of(record);
        std::vector<Json> &row = table.rows.emplace_back();
        for (const auto &path : paths) {
            row.push_back(json.contains(path) ? json.at(path) : Json());
        }
    }
    return table;
}

std::string quoted(const std::string &text)
{
    if (text.find_first_of(",\"\r\n") == std::string::npos) {
        return text;
    }
    std::string cell = "\"";
    for (const char character : text) {
        cell += character;
        if (character == '"') {
            cell += '"';
        }
    }
    return cell + '"';
}

std::string cell_of(const Json &value)
{
    return value.is_null() ? "" : value.is_string() ? quoted(value.get<std::string>()) : value.dump();
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
    add_line(table.columns, quoted);
    for (const auto &row : table.rows) {
        add_line(row, cell_of);
    }
    return text;
}

} // namespace tsr
