// Prints what changes in a log in SI, and goes on from a saved state in its middle: monitor cylinder.bin log.csv
#include "cylwatch.hpp"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <iterator>
#include <sstream>

static std::vector<double> cells(const std::string &line) {
    std::vector<double> numbers;
    std::istringstream stream(line);
    for (std::string cell; std::getline(stream, cell, ',');)
        numbers.push_back(cell.empty() ? std::nan("") : std::stod(cell));
    return numbers;
}

static void print(cylwatch::Monitor &monitor, std::optional<cw_output> row) {
    for (; row; row = monitor.next())
        for (std::uint32_t index = 0; index < row->event_count; index++)
            std::printf("%s\n", monitor.event(index).id);
}

int main(int count, char **names) try {
    if (count != 3) {
        std::cerr << "usage: monitor cylinder.bin log.csv\n";
        return 2;
    }
    std::ifstream file(names[1], std::ios::binary), log(names[2]);
    const cylwatch::Bytes blob{std::istreambuf_iterator<char>(file), {}};
    std::vector<std::vector<double>> rows;
    std::string line;
    for (std::getline(log, line); std::getline(log, line);)
        rows.push_back(cells(line));
    cylwatch::Monitor monitor(blob);
    for (std::size_t at = 0; at < rows.size(); at++) {
        if (at == rows.size() / 2)
            monitor = cylwatch::Monitor::restored(blob, monitor.save());
        const std::vector<double> readings(rows[at].begin() + 1, rows[at].end());
        print(monitor, monitor.step(rows[at][0], readings));
    }
    print(monitor, monitor.finish());
    return 0;
} catch (const cylwatch::Error &error) {
    std::cerr << "code " << error.code() << ": " << error.what() << "\n";
    return 2;
}
