// cylwatch for C++17: a monitor that owns its arena, errors as exceptions. Everything else is in cylwatch.h.
#ifndef CYLWATCH_HPP
#define CYLWATCH_HPP

#include "cylwatch.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace cylwatch {

using Bytes = std::vector<std::uint8_t>;

/// Why a call was refused: its code, and words with value, bound and remedy.
class Error : public std::runtime_error {
public:
    Error(cw_code code, const std::string &words) : std::runtime_error(words), code_(code) {}
    cw_code code() const noexcept { return code_; }

private:
    cw_code code_;
};

/// Size of an arena that a compiled cylinder needs, bytes.
inline std::size_t size(const Bytes &blob) {
    std::size_t bytes = 0;
    const cw_code code = cw_size(blob.data(), blob.size(), &bytes);
    if (code != CW_OK)
        throw Error(code, cw_error_text(code));
    return bytes;
}

/// The monitor of one cylinder; one caller at a time.
class Monitor {
public:
    /// Begins with the first row, in an arena of so many bytes; 0: as many as are needed.
    explicit Monitor(const Bytes &blob, std::size_t arena_bytes = 0) : Monitor(blob, nullptr, arena_bytes) {}

    /// Goes on from a saved state.
    static Monitor restored(const Bytes &blob, const Bytes &state, std::size_t arena_bytes = 0) {
        return Monitor(blob, &state, arena_bytes);
    }

    Monitor(Monitor &&other) noexcept
        : arena_(std::move(other.arena_)), handle_(std::exchange(other.handle_, nullptr)) {}
    Monitor &operator=(Monitor &&other) noexcept {
        arena_ = std::move(other.arena_);
        handle_ = std::exchange(other.handle_, nullptr);
        return *this;
    }
    Monitor(const Monitor &) = delete;
    Monitor &operator=(const Monitor &) = delete;

    /// Takes in a row: its time, s, and the readings in K and Pa, NaN where missing. The first row that is ready; next() gives others.
    std::optional<cw_output> step(double time_s, const std::vector<double> &readings) {
        cw_output output;
        return row(cw_step(handle_, time_s, readings.data(), readings.size(), &output), output);
    }

    /// The next row that is ready.
    std::optional<cw_output> next() {
        cw_output output;
        return row(cw_next(handle_, &output), output);
    }

    /// The rows have come to their end: what was held back.
    std::optional<cw_output> finish() {
        cw_output output;
        return row(cw_finish(handle_, &output), output);
    }

    /// An event of the last row, below its event_count.
    cw_event event(std::uint32_t index) {
        cw_event event;
        check(cw_event_at(handle_, index, &event));
        return event;
    }

    /// A change of an alarm at the last row, below its alarm_count, or by acknowledge().
    cw_alarm alarm(std::uint32_t index) {
        cw_alarm alarm;
        check(cw_alarm_at(handle_, index, &alarm));
        return alarm;
    }

    /// A person has seen the alarms; how many of them have changed.
    std::uint32_t acknowledge(std::string_view comment) {
        std::uint32_t count = 0;
        check(cw_acknowledge(handle_, comment.data(), comment.size(), &count));
        return count;
    }

    /// An exchange of gas is announced between two times, s.
    void announce(double from_s, double until_s) { check(cw_announce(handle_, from_s, until_s)); }

    /// Everything that restored() needs.
    Bytes save() {
        std::size_t bytes = 0;
        const cw_code code = cw_save(handle_, nullptr, 0, &bytes);
        if (code != CW_BUFFER_TOO_SMALL)
            check(code);
        Bytes state(bytes);
        check(cw_save(handle_, state.data(), state.size(), &bytes));
        return state;
    }

    /// Memory of the arena.
    cw_memory memory() {
        cw_memory memory;
        check(cw_memory_of(handle_, &memory));
        return memory;
    }

private:
    Monitor(const Bytes &blob, const Bytes *state, std::size_t arena_bytes) {
        const std::size_t bytes = arena_bytes == 0 ? size(blob) : arena_bytes;
        arena_.reset(new std::uint8_t[bytes]);
        check(state == nullptr ? cw_init(arena_.get(), bytes, blob.data(), blob.size(), &handle_)
                               : cw_restore(arena_.get(), bytes, blob.data(), blob.size(), state->data(), state->size(),
                                            &handle_));
    }

    void check(cw_code code) const {
        if (code == CW_OK)
            return;
        char detail[CW_TEXT_SIZE] = "";
        if (handle_ != nullptr)
            cw_detail(handle_, detail, sizeof detail);
        throw Error(code, detail[0] == '\0' ? cw_error_text(code) : detail);
    }

    std::optional<cw_output> row(cw_code code, const cw_output &output) const {
        if (code == CW_NO_ROW)
            return std::nullopt;
        check(code);
        return output;
    }

    std::unique_ptr<std::uint8_t[]> arena_;
    cw_handle *handle_ = nullptr;
};

} // namespace cylwatch

#endif
