/* Prints the verdicts of a log in SI: monitor cylinder.bin log.csv, with the columns time_s and the readings in the
 * order of `cylwatch compile`; an empty cell is a reading that is missing. */
#include "cylwatch.h"
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void check(cw_code code, cw_handle *handle, int line) {
    char detail[CW_TEXT_SIZE] = "";
    if (code == CW_OK || code == CW_NO_ROW)
        return;
    if (handle != NULL)
        cw_detail(handle, detail, sizeof detail);
    fprintf(stderr, "line %d: %s: %s\n", line, cw_error_text(code), detail);
    exit(2);
}

static void print(cw_code code, cw_handle *handle, cw_output *row, int line) {
    static const char *const verdicts[] = {"tight", "leak", "discharge", "refill", "sensor fault", "unknown"};
    for (; code == CW_OK; code = cw_next(handle, row))
        printf("%.0f,%s,%.4f,%.3g\n", row->time_s, verdicts[row->verdict], row->mass_kg, row->leak_probability);
    check(code, handle, line);
}

int main(int count, char **names) {
    static unsigned char blob[1 << 16];
    char text[256];
    size_t blob_size, arena_size = 0;
    cw_handle *handle = NULL;
    cw_output row;
    FILE *file = count == 3 ? fopen(names[1], "rb") : NULL;
    FILE *log = count == 3 ? fopen(names[2], "r") : NULL;
    if (file == NULL || log == NULL) {
        fprintf(stderr, "usage: monitor cylinder.bin log.csv\n");
        return 2;
    }
    blob_size = fread(blob, 1, sizeof blob, file);
    check(cw_size(blob, blob_size, &arena_size), NULL, 0);
    void *arena = malloc(arena_size);
    check(cw_init(arena, arena_size, blob, blob_size, &handle), handle, 0);
    puts("time_s,verdict,mass_kg,leak_probability");
    for (int line = 1; fgets(text, sizeof text, log) != NULL; line++) {
        double cells[1 + CW_MOST_SENSORS];
        size_t cell = 0;
        for (char *at = text; line > 1 && at != NULL && cell < 1 + CW_MOST_SENSORS; cell++) {
            char *end = at;
            double number = strtod(at, &end);
            cells[cell] = end == at ? NAN : number;
            at = strchr(end, ',');
            at = at == NULL ? NULL : at + 1;
        }
        if (cell > 0)
            print(cw_step(handle, cells[0], cells + 1, cell - 1, &row), handle, &row, line);
    }
    print(cw_finish(handle, &row), handle, &row, 0);
    free(arena);
    return 0;
}
