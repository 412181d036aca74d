/* cylwatch for C and C++: the monitor of a compiled cylinder in memory that the caller gives.
 *
 *   cw_size(blob, ...)  cw_init(arena, ..., blob, ..., &handle)  cw_step(handle, time, readings, n, &output)  cw_save  cw_restore
 *
 * SI throughout, the unit in the name. Errors are codes: cw_error_text says what a code is, cw_detail what was wrong.
 * Made by cbindgen from bindings/c/src; do not edit. */

#ifndef CYLWATCH_H
#define CYLWATCH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>


// Room for the name of an event, with its end.
#define CW_ID_SIZE 64

// Room for a comment and for the words of an error, with its end.
#define CW_TEXT_SIZE 512

// Most sensors of a cylinder.
#define CW_MOST_SENSORS 8

// What a call answers. Below `CW_NULL` nothing is wrong.
enum cw_code
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // Done; where there is an output, it is filled in.
  CW_OK = 0,
  // Done; no row is ready, and the output is as it was.
  CW_NO_ROW = 1,
  // A pointer is null.
  CW_NULL = 2,
  // A pointer is not aligned.
  CW_MISALIGNED = 3,
  // A size reaches beyond the address space.
  CW_SIZE = 4,
  // The handle is none, or its arena has been moved or written over.
  CW_HANDLE = 5,
  // The monitor did not begin, or has ended with an error.
  CW_ENDED = 6,
  // The arena is too small to begin in.
  CW_ARENA_TOO_SMALL = 7,
  // The arena is full: the monitor has ended.
  CW_OUT_OF_MEMORY = 8,
  // The buffer is too small; the size that is needed is filled in.
  CW_BUFFER_TOO_SMALL = 9,
  // The bytes are no compiled cylinder, or no state of a monitor.
  CW_OTHER_BYTES = 10,
  // The bytes have another version.
  CW_VERSION = 11,
  // The state is that of another cylinder.
  CW_FOREIGN = 12,
  // The bytes are cut short.
  CW_CUT = 13,
  // The bytes are damaged.
  CW_DAMAGED = 14,
  // The cylinder has more than `CW_MOST_SENSORS` sensors.
  CW_SENSORS = 15,
  // A row has another number of readings than the cylinder has sensors.
  CW_READINGS = 16,
  // Rows are waiting: take them with cw_next first.
  CW_ROWS_WAITING = 17,
  // There is none with this index.
  CW_INDEX = 18,
  // A text is not UTF-8 or too long.
  CW_TEXT = 19,
  // The monitor refuses a value: a setting out of its bounds, or a gas that has no such state.
  CW_REFUSED = 20,
  // Not without an operating system.
  CW_HOSTED_ONLY = 21,
  // A mistake inside the library: the monitor has ended.
  CW_PANICKED = 22,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum cw_code cw_code;
#else
typedef int32_t cw_code;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What is happening to the gas.
enum cw_verdict
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // No gas is being lost that could be seen.
  CW_VERDICT_TIGHT = 0,
  // Gas is being lost steadily.
  CW_VERDICT_LEAK = 1,
  // Gas was let out fast, or is being.
  CW_VERDICT_DISCHARGE = 2,
  // Gas was put in, or is being.
  CW_VERDICT_REFILL = 3,
  // A sensor is at fault; what is said of the gas rests on the others.
  CW_VERDICT_SENSOR_FAULT = 4,
  // It cannot be told, and never counts as tight.
  CW_VERDICT_UNKNOWN = 5,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum cw_verdict cw_verdict;
#else
typedef int32_t cw_verdict;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Why it cannot be told.
enum cw_reason
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // It can be told.
  CW_REASON_NONE = 0,
  // Still learning the sensors.
  CW_REASON_LEARNING = 1,
  // The readings do not fit the filling that was stated.
  CW_REASON_FILLING = 2,
  // No usable pressure.
  CW_REASON_NO_PRESSURE = 3,
  // No usable temperature.
  CW_REASON_NO_TEMPERATURE = 4,
  // No rows for too long.
  CW_REASON_GAP = 5,
  // The pressure jumped: gas or transmitter.
  CW_REASON_JUMP = 6,
  // Gas was exchanged and has not settled.
  CW_REASON_SETTLING = 7,
  // One end of the cylinder is warmed or cooled by itself.
  CW_REASON_DISTURBED = 8,
  // A reading stands still.
  CW_REASON_STUCK = 9,
  // The clock jumped.
  CW_REASON_CLOCK = 10,
  // The estimate had to begin again.
  CW_REASON_RESTARTED = 11,
  // A leak is likely, but not certain yet.
  CW_REASON_SUSPECTED = 12,
  // The cylinder is nearly empty: no leak would show.
  CW_REASON_EMPTY = 13,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum cw_reason cw_reason;
#else
typedef int32_t cw_reason;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Whether gas is being lost.
enum cw_outcome
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // No gas is being lost.
  CW_OUTCOME_NO_LOSS = 0,
  // Gas is being lost.
  CW_OUTCOME_LOSS = 1,
  // It cannot be told.
  CW_OUTCOME_UNKNOWN = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum cw_outcome cw_outcome;
#else
typedef int32_t cw_outcome;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What to do, the least urgent first.
enum cw_reaction
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // It is not known.
  CW_REACTION_UNKNOWN = -1,
  // Nothing.
  CW_REACTION_NONE = 0,
  // Refill or replace at the next service.
  CW_REACTION_NEXT_INTERVAL = 1,
  // Maintenance before the next service.
  CW_REACTION_AS_SOON_AS_POSSIBLE = 2,
  // Stop using the vehicle.
  CW_REACTION_SHUTDOWN = 3,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum cw_reaction cw_reaction;
#else
typedef int32_t cw_reaction;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// How far to rely on an estimate.
enum cw_quality
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // Every sensor was heard.
  CW_QUALITY_GOOD = 0,
  // A sensor had no reading, or its reading was rejected.
  CW_QUALITY_DEGRADED = 1,
  // No reading at all: the model alone.
  CW_QUALITY_PREDICTED = 2,
  // Gas is or was just exchanged: mass and gas temperature are free.
  CW_QUALITY_OPEN = 3,
  // The estimate began again from its prior.
  CW_QUALITY_RESTARTED = 4,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum cw_quality cw_quality;
#else
typedef int32_t cw_quality;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// How a sensor is doing.
enum cw_health_state
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // As it should.
  CW_HEALTH_STATE_GOOD = 0,
  // No readings.
  CW_HEALTH_STATE_MISSING = 1,
  // Readings outside what it can read.
  CW_HEALTH_STATE_IMPLAUSIBLE = 2,
  // Readings that stand still.
  CW_HEALTH_STATE_STUCK = 3,
  // Single readings far off.
  CW_HEALTH_STATE_SPIKES = 4,
  // Its offset jumped, which is taken into account.
  CW_HEALTH_STATE_SHIFTED = 5,
  // Off for half an hour, while the other thermometer agrees with the pressure.
  CW_HEALTH_STATE_DEVIATES = 6,
  // It follows the air instead of the surface.
  CW_HEALTH_STATE_DETACHED = 7,
  // There is no such sensor.
  CW_HEALTH_STATE_NO_SENSOR = 8,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum cw_health_state cw_health_state;
#else
typedef int32_t cw_health_state;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Kinds of events.
enum cw_event_kind
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // The verdict changed: `verdict_from`, `verdict_to` and their reasons.
  CW_EVENT_KIND_VERDICT = 0,
  // A leak was found: `leak_rate_kg_s`.
  CW_EVENT_KIND_LEAK_FOUND = 1,
  // A leak is over, or was none.
  CW_EVENT_KIND_LEAK_ENDED = 2,
  // Gas went out at once: `mass_kg`.
  CW_EVENT_KIND_DISCHARGE = 3,
  // Gas was put in: `mass_kg`.
  CW_EVENT_KIND_REFILL = 4,
  // The health of `sensor` changed: `health`.
  CW_EVENT_KIND_SENSOR = 5,
  // The raw pressure, `pressure_pa`, will be below the limit at the coldest temperature expected.
  CW_EVENT_KIND_COLD_NIGHT = 6,
  // The first readings stand for `mass_kg` where `filled_kg` was stated.
  CW_EVENT_KIND_FILLING_DOUBTED = 7,
  // Two thermometers, `sensor` and `other_sensor`, were in each other's place.
  CW_EVENT_KIND_SWAPPED = 8,
  // The channel of `sensor` is late by `duration_s`.
  CW_EVENT_KIND_LATE = 9,
  // `sensor` and `other_sensor` have been apart by `difference_k` for an hour.
  CW_EVENT_KIND_DISTURBED = 10,
  // The clock jumped by `duration_s`.
  CW_EVENT_KIND_CLOCK_JUMP = 11,
  // Rows came after a gap of `duration_s`.
  CW_EVENT_KIND_GAP = 12,
  // A row came too late to be used.
  CW_EVENT_KIND_TOO_LATE = 13,
  // The estimate began again from its prior.
  CW_EVENT_KIND_RESTARTED = 14,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum cw_event_kind cw_event_kind;
#else
typedef int32_t cw_event_kind;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Alarms of a cylinder.
enum cw_alarm_name
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // Gas is being lost.
  CW_ALARM_NAME_LEAK = 0,
  // The pressure at 15 degrees Celsius is at the operational limit or near it.
  CW_ALARM_NAME_OPERATIONAL_LIMIT = 1,
  // So much pressure is lost that the cylinder must be refilled.
  CW_ALARM_NAME_MAINTENANCE_LIMIT = 2,
  // A sensor is not as it should be.
  CW_ALARM_NAME_SENSOR_FAULT = 3,
  // Nothing can be said of the gas.
  CW_ALARM_NAME_UNKNOWN = 4,
  // The pressure will be below the limit on the coldest night.
  CW_ALARM_NAME_COLD_NIGHT = 5,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum cw_alarm_name cw_alarm_name;
#else
typedef int32_t cw_alarm_name;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// What changed about an alarm, by OPC UA Part 9.
enum cw_alarm_change
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // It became active.
  CW_ALARM_CHANGE_ACTIVE = 0,
  // It is at another limit than before.
  CW_ALARM_CHANGE_LIMIT_CHANGED = 1,
  // It is active still and was raised again.
  CW_ALARM_CHANGE_RE_ALARM = 2,
  // It returned to normal.
  CW_ALARM_CHANGE_INACTIVE = 3,
  // It was acknowledged.
  CW_ALARM_CHANGE_ACKNOWLEDGED = 4,
  // It was confirmed.
  CW_ALARM_CHANGE_CONFIRMED = 5,
  // The latch was released.
  CW_ALARM_CHANGE_RESET = 6,
  // It is watched again.
  CW_ALARM_CHANGE_ENABLED = 7,
  // It is not watched any more.
  CW_ALARM_CHANGE_DISABLED = 8,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum cw_alarm_change cw_alarm_change;
#else
typedef int32_t cw_alarm_change;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// Limit at which an alarm is.
enum cw_alarm_limit
#if defined(__cplusplus) || __STDC_VERSION__ >= 202311L
  : int32_t
#endif // defined(__cplusplus) || __STDC_VERSION__ >= 202311L
 {
  // It has none, or is at none.
  CW_ALARM_LIMIT_NONE = 0,
  // At or below the first.
  CW_ALARM_LIMIT_LOW = 1,
  // At or below the second.
  CW_ALARM_LIMIT_LOW_LOW = 2,
};
#ifndef __cplusplus
#if __STDC_VERSION__ >= 202311L
typedef enum cw_alarm_limit cw_alarm_limit;
#else
typedef int32_t cw_alarm_limit;
#endif // __STDC_VERSION__ >= 202311L
#endif // __cplusplus

// A monitor in its arena. Whoever has it calls from one thread at a time.
typedef struct cw_handle cw_handle;

// A value with its 95 % interval.
typedef struct {
  // Estimate.
  double value;
  // Lower bound.
  double low;
  // Upper bound.
  double high;
} cw_interval;

// Time until a limit is reached: before `p5_s` with 5 %. 0: it has been reached; infinite: not within the horizon; NaN: not known.
typedef struct {
  // 5 %, s.
  double p5_s;
  // Median, s.
  double p50_s;
  // 95 %, s.
  double p95_s;
  // The horizon, s.
  double horizon_s;
} cw_time_left;

// Health of a sensor.
typedef struct {
  // How it is doing.
  cw_health_state state;
  // Off by so much, K or Pa; NaN where that is not said.
  double off_k_or_pa;
} cw_health;

// What is said of a row.
typedef struct {
  // Time as the row was stamped, s.
  double stamp_s;
  // The same without jumps of the clock, s.
  double time_s;
  // What is happening to the gas.
  cw_verdict verdict;
  // Why it cannot be told.
  cw_reason reason;
  // Whether gas is being lost.
  cw_outcome outcome;
  // What is due now.
  cw_reaction reaction;
  // How far to rely on the estimate.
  cw_quality quality;
  // Sensors of the cylinder.
  uint32_t sensor_count;
  // Events at this row: cw_event_at gives them.
  uint32_t event_count;
  // Changes of alarms at this row: cw_alarm_at gives them.
  uint32_t alarm_count;
  // Probability that gas is being lost.
  double leak_probability;
  // Mean gas temperature, K.
  double gas_mean_k;
  // Its standard deviation, K.
  double gas_mean_sd_k;
  // Gas mass, kg.
  double mass_kg;
  // Its standard deviation, kg.
  double mass_sd_kg;
  // Leak rate as the observer estimates it, kg/s.
  double estimated_leak_kg_s;
  // Its standard deviation, kg/s.
  double estimated_leak_sd_kg_s;
  // Pressure as read, Pa.
  double pressure_pa;
  // Pressure that the transmitter would show with the mass of the reference, Pa.
  double pressure_expected_pa;
  // Pressure of the mass at 15 degrees Celsius, Pa.
  double pressure_at_15_degc_pa;
  // Raw pressure at the coldest temperature expected, Pa.
  double cold_pressure_pa;
  // Leak rate, kg/s: of the leak that is found, else from 0 to what a leak is below with 97.5 %.
  cw_interval leak_rate_kg_s;
  // Whether a leak is found; else the three below are NaN.
  bool leak_found;
  // Loss of the pressure at 15 degrees Celsius, Pa/s.
  cw_interval leak_rate_pa_s;
  // When the leak began, s.
  cw_interval leak_onset_s;
  // Mass lost since, kg.
  cw_interval lost_kg;
  // Whether there is an outlook; else what is below is NaN or unknown.
  bool outlook_known;
  // Whether it rests on a leak; else on limits that are reached alone.
  bool outlook_of_leak;
  // Until the pressure at 15 degrees Celsius is at the operational limit.
  cw_time_left operational_limit;
  // Until the raw pressure at the coldest temperature expected is at the operational limit.
  cw_time_left cold_limit;
  // Until the maintenance limit.
  cw_time_left maintenance_limit;
  // What is due by the time that is left.
  cw_reaction advice;
  // Probability that the operational limit is reached before a safe state.
  double before_safe_state_probability;
  // Probability that it is reached before the next service.
  double before_next_service_probability;
  // Probability that the maintenance limit is reached before the service after the next.
  double before_following_service_probability;
  // Health of each sensor, in the order of the readings.
  cw_health health[CW_MOST_SENSORS];
} cw_output;

// Something that happened.
typedef struct {
  // What it was.
  cw_event_kind kind;
  // Index of the sensor, or -1.
  int32_t sensor;
  // Index of the other sensor, or -1.
  int32_t other_sensor;
  // Verdict before.
  cw_verdict verdict_from;
  // Its reason.
  cw_reason reason_from;
  // Verdict now.
  cw_verdict verdict_to;
  // Its reason.
  cw_reason reason_to;
  // Health of the sensor.
  cw_health health;
  // Time of the row at which it was noticed, s.
  double time_s;
  // When it began, s.
  double onset_s;
  // Leak rate, kg/s.
  cw_interval leak_rate_kg_s;
  // Mass, kg.
  double mass_kg;
  // Mass that was stated, kg.
  double filled_kg;
  // Pressure, Pa.
  double pressure_pa;
  // Time, s.
  double duration_s;
  // Difference of two thermometers, K.
  double difference_k;
  // The same for the same happening however often the rows are replayed; ends with 0.
  char id[CW_ID_SIZE];
} cw_event;

// A change of an alarm, and its state after it.
typedef struct {
  // Which alarm.
  cw_alarm_name name;
  // What changed.
  cw_alarm_change change;
  // Limit at which it is.
  cw_alarm_limit limit;
  // 1 to 1000.
  uint32_t severity;
  // How often it was raised again since it became active.
  int32_t re_alarm_repeat_count;
  // ActiveState.
  bool active;
  // AckedState.
  bool acked;
  // ConfirmedState.
  bool confirmed;
  // LatchedState.
  bool latched;
  // Time of the change, s.
  double time_s;
  // Since when it is active, or was last, s.
  double active_since_s;
  // The same for the same change however often the rows are replayed; ends with 0.
  char id[CW_ID_SIZE];
} cw_alarm;

// Memory of an arena.
typedef struct {
  // The arena, bytes.
  size_t size_bytes;
  // From its start to the highest byte that has been in use, bytes: an arena as large would have been enough.
  size_t reached_bytes;
  // In use now, bytes, without what blocks need for themselves.
  size_t used_bytes;
  // Allocations since the monitor began.
  uint64_t allocations;
} cw_memory;

#ifdef __cplusplus
extern "C" {
#endif // __cplusplus

// Version of the library.
const char *cw_version(void);

// Words for a code, which stay where they are.
const char *cw_error_text(int32_t code);

// Size of an arena that a compiled cylinder (`cylwatch compile`) needs, bytes. It is found by trying, which takes a second, and on
// an operating system alone; a machine with smaller pointers needs less.
//
// # Safety
// `blob_size` bytes can be read, a size can be written.
cw_code cw_size(const uint8_t *blob,
                size_t blob_size,
                size_t *size);

// Begins a monitor of a compiled cylinder. All that it needs lies in the arena, of any alignment, until the arena is used for
// something else; there is nothing to free. The handle is null where the arena is too small for any; else it is there even when
// the monitor is refused, for cw_detail to say why. The blob is not needed any more.
//
// # Safety
// `arena_size` bytes can be written and `blob_size` others read, a handle can be written.
cw_code cw_init(uint8_t *arena,
                size_t arena_size,
                const uint8_t *blob,
                size_t blob_size,
                cw_handle **handle);

// Begins a monitor that goes on from a saved state of the same cylinder, else as cw_init.
//
// # Safety
// As cw_init; `state_size` bytes can be read, too.
cw_code cw_restore(uint8_t *arena,
                   size_t arena_size,
                   const uint8_t *blob,
                   size_t blob_size,
                   const uint8_t *state,
                   size_t state_size,
                   cw_handle **handle);

// Takes in a row: its time, s, and a reading for each sensor in the order of `cylwatch compile`, K and Pa absolute, NaN where one
// is missing. CW_OK: a row is ready and in the output; cw_next gives the others. CW_NO_ROW: none is. Rows that lie closer
// together than a minute are united, and late ones wait for their place.
//
// # Safety
// The handle is that of cw_init or cw_restore, in an arena that is as they left it; `count` readings can be read, an output
// written.
cw_code cw_step(cw_handle *handle,
                double time_s,
                const double *readings,
                size_t count,
                cw_output *output);

// The next row that is ready, until CW_NO_ROW.
//
// # Safety
// The handle as for cw_step; an output can be written.
cw_code cw_next(cw_handle *handle, cw_output *output);

// The rows have come to their end: what was held back, as cw_step.
//
// # Safety
// As cw_next.
cw_code cw_finish(cw_handle *handle, cw_output *output);

// An event of the last output, by its index.
//
// # Safety
// The handle as for cw_step; an event can be written.
cw_code cw_event_at(cw_handle *handle, uint32_t index, cw_event *event);

// A change of an alarm at the last output or by cw_acknowledge, by its index.
//
// # Safety
// The handle as for cw_step; an alarm can be written.
cw_code cw_alarm_at(cw_handle *handle, uint32_t index, cw_alarm *alarm);

// A person has seen the alarms, looked after the sensors and knows the filling. The comment is UTF-8 of so many bytes, without an
// end; the count is that of the changes, which cw_alarm_at gives.
//
// # Safety
// The handle as for cw_step; `comment_size` bytes can be read, a count written.
cw_code cw_acknowledge(cw_handle *handle,
                       const char *comment,
                       size_t comment_size,
                       uint32_t *alarm_count);

// An exchange of gas is announced between two times, s, as rows are stamped: what goes out then is no loss.
//
// # Safety
// The handle as for cw_step.
cw_code cw_announce(cw_handle *handle, double from_s, double until_s);

// Everything that cw_restore needs, as bytes. Their number is written even when the buffer is too small; with a capacity of 0 the
// buffer may be null.
//
// # Safety
// The handle as for cw_step; `capacity` bytes and a size can be written.
cw_code cw_save(cw_handle *handle,
                uint8_t *buffer,
                size_t capacity,
                size_t *written);

// Words for the last error of a handle, with its value, bound and remedy; cut to the buffer, and with an end.
//
// # Safety
// The handle as for cw_step; `capacity` bytes can be written.
cw_code cw_detail(cw_handle *handle, char *buffer, size_t capacity);

// Memory of the arena.
//
// # Safety
// The handle as for cw_step; a cw_memory can be written.
cw_code cw_memory_of(cw_handle *handle, cw_memory *to);

#if defined(CW_NO_SYSTEM)
// To be written by whoever links the library: stops the machine or starts it anew, and does not return.
extern void cw_panicked(void);
#endif

#ifdef __cplusplus
}  // extern "C"
#endif  // __cplusplus

#endif  /* CYLWATCH_H */
