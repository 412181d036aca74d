/* Replays log.csv through cylinder.bin, with a restore in the middle as bindings/controller does it; writes rows.raw and state.raw in the
 * folder where it runs, a few columns as text, rows.csv, and the log as numbers, log.raw; says how often the monitor allocated. */
#include "cylwatch.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void check(cw_code code, cw_handle *handle) {
    char detail[CW_TEXT_SIZE] = "";
    if (code == CW_OK || code == CW_NO_ROW)
        return;
    if (handle != NULL)
        cw_detail(handle, detail, sizeof detail);
    fprintf(stderr, "%s: %s\n", cw_error_text(code), detail);
    exit(2);
}

static FILE *opened(const char *name, const char *mode) {
    FILE *file = fopen(name, mode);
    if (file == NULL) {
        perror(name);
        exit(2);
    }
    return file;
}

static size_t cells_of(char *line, double *cells) {
    size_t count = 0;
    for (char *at = line; at != NULL && count < 1 + CW_MOST_SENSORS; count++) {
        char *end = at;
        double number = strtod(at, &end);
        cells[count] = end == at ? NAN : number;
        at = strchr(end, ',');
        at = at == NULL ? NULL : at + 1;
    }
    return count;
}

static unsigned long rows, allocations, reached;

static void add(cw_handle *handle) {
    cw_memory memory;
    check(cw_memory_of(handle, &memory), handle);
    allocations += (unsigned long)memory.allocations;
    reached = memory.reached_bytes > reached ? (unsigned long)memory.reached_bytes : reached;
}

static void write_rows(cw_code code, cw_handle *handle, cw_output *row, FILE *out, FILE *text) {
    for (; code == CW_OK; code = cw_next(handle, row), rows++) {
        fwrite(row, sizeof *row, 1, out);
        fprintf(text, "%a,%a,%a,%a\n", row->time_s, row->mass_kg, row->gas_mean_sd_k, row->leak_probability);
    }
    check(code, handle);
}

int main(void) {
    static unsigned char blob[1 << 16], state[1 << 20];
    char line[256];
    size_t blob_size, arena_size, state_size;
    long lines = 0, row = 0;
    cw_handle *handle = NULL;
    cw_output output;
    FILE *file = opened("cylinder.bin", "rb"), *log = opened("log.csv", "r"), *out = opened("rows.raw", "wb"),
         *numbers = opened("log.raw", "wb"), *text = opened("rows.csv", "w");
    blob_size = fread(blob, 1, sizeof blob, file);
    fclose(file);
    while (fgets(line, sizeof line, log) != NULL)
        lines++;
    rewind(log);
    check(cw_size(blob, blob_size, &arena_size), NULL);
    unsigned char *arenas[2] = {malloc(arena_size), malloc(arena_size)};
    check(cw_init(arenas[0], arena_size, blob, blob_size, &handle), handle);
    if (fgets(line, sizeof line, log) == NULL)
        return 2;
    for (; fgets(line, sizeof line, log) != NULL; row++) {
        double cells[1 + CW_MOST_SENSORS];
        if (row == (lines - 1) / 2) {
            check(cw_save(handle, state, sizeof state, &state_size), handle);
            add(handle);
            check(cw_restore(arenas[1], arena_size, blob, blob_size, state, state_size, &handle), handle);
            memset(arenas[0], 0xff, arena_size);
        }
        size_t count = cells_of(line, cells);
        fwrite(cells, sizeof cells[0], count, numbers);
        write_rows(cw_step(handle, cells[0], cells + 1, count - 1, &output), handle, &output, out, text);
    }
    write_rows(cw_finish(handle, &output), handle, &output, out, text);
    fclose(out);
    fclose(log);
    fclose(numbers);
    fclose(text);
    add(handle);
    check(cw_save(handle, state, sizeof state, &state_size), handle);
    out = opened("state.raw", "wb");
    fwrite(state, 1, state_size, out);
    fclose(out);
    printf("rows %lu\narena %lu bytes, %lu reached\nallocations after the monitor has begun %lu\n", rows,
           (unsigned long)arena_size, reached, allocations);
    free(arenas[0]);
    free(arenas[1]);
    return 0;
}
