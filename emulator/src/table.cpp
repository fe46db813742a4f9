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

std::string text_of(const Json &value)
{
    return value.is_null() ? "" : value.is_string() ? value.get<std::string>() : value.dump();
}

struct AlignedColumn {
    std::vector<std::string> cells; /* its name, then its rows */
    std::size_t width = 0;
    bool is_text = false;
};

AlignedColumn aligned_column(const Table &table, std::size_t index)
{
    AlignedColumn column{{table.columns[index]}, table.columns[index].size(), false};
    for (const auto &row : table.rows) {
        column.cells.push_back(text_of(row[index]));
        column.width = std::max(column.width, column.cells.back().size());
        column.is_text = column.is_text || row[index].is_string();
    }
    return column;
}

void print_columns(const std::vector<AlignedColumn> &columns, const std::vector<std::size_t> &shown, std::string &text)
{
    constexpr const char *kGap = "  ";
    for (std::size_t row = 0; row < columns.front().cells.size(); ++row) {
        std::string line;
        for (const std::size_t index : shown) {
            const AlignedColumn &column = columns[index];
            const std::string &cell = column.cells[row];
            const std::string blanks(column.width - cell.size(), ' ');
            line += (line.empty() ? "" : kGap) + (column.is_text ? cell + blanks : blanks + cell);
        }
        text += line.substr(0, line.find_last_not_of(' ') + 1) + '\n';
    }
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
        add_line(row, [](const Json &value) { return csv_field(text_of(value)); });
    }
    return text;
}

std::string aligned_text(const Table &table, std::size_t kept, std::size_t width)
{
    std::vector<AlignedColumn> columns;
    for (std::size_t i = 0; i < table.columns.size(); ++i) {
        columns.push_back(aligned_column(table, i));
    }
    std::string text;
    for (std::size_t next = kept; next < columns.size();) {
        std::vector<std::size_t> shown;
        std::size_t used = 0;
        const auto show = [&](std::size_t index) {
            shown.push_back(index);
            used += columns[index].width + 2;
        };
        for (std::size_t i = 0; i < kept; ++i) {
            show(i);
        }
        do {
            show(next++);
        } while (next < columns.size() && (width == 0 || used + columns[next].width <= width));
        text += text.empty() ? "" : "\n";
        print_columns(columns, shown, text);
    }
    return text;
}

} // namespace tsr
