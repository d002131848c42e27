/* The BRDF of a level surface in wind, and the empirical model's mean and spread of a drawn sea, from C.
 *
 *     cargo rustc -p prob-water --release --features c-api --crate-type staticlib
 *     cc -std=c99 -I rust-core/include rust-core/examples/brdf.c target/release/libprob_water.a -lm -lpthread -ldl -o brdf
 *
 * or with the shared library, of `--crate-type cdylib`:
 *
 *     cc -std=c99 -I rust-core/include rust-core/examples/brdf.c -L target/release -lprob_water -o brdf
 *     LD_LIBRARY_PATH=target/release ./brdf
 */
#include "prob_water.h"

#include <stdio.h>

enum { ROWS = 3 };

int main(void) {
    /* Unit vectors away from the surface, z up: a source at 30 degrees, observers overhead, at the mirror and beyond. */
    const double to_source[3 * ROWS] = {-0.5, 0, 0.8660254037844386, -0.5, 0, 0.8660254037844386, -0.5, 0, 0.8660254037844386};
    const double to_observer[3 * ROWS] = {0, 0, 1, 0.5, 0, 0.8660254037844386, 0.8660254037844386, 0, 0.5};
    ProbWaterOptions *options = prob_water_options_new();
    ProbWater *flat = NULL, *sea = NULL;
    double f[ROWS], mean[ROWS], spread[ROWS];
    unsigned char outside[ROWS];
    int row;

    /* The first call that fails leaves its reason. */
    const int failed = prob_water_options_set_number(options, "friction_velocity", 8) != PROB_WATER_STATUS_OK
        || prob_water_options_set(options, "wind_direction", "45") != PROB_WATER_STATUS_OK
        || prob_water_configure(options, &flat) != PROB_WATER_STATUS_OK
        || prob_water_options_set(options, "surface", "empirical") != PROB_WATER_STATUS_OK
        || prob_water_configure(options, &sea) != PROB_WATER_STATUS_OK
        || prob_water_eval(flat, ROWS, to_source, to_observer, NULL, f) != PROB_WATER_STATUS_OK
        || prob_water_estimate(sea, ROWS, to_source, to_observer, mean, spread, outside) != PROB_WATER_STATUS_OK;

    if (failed)
        fprintf(stderr, "%s\n", prob_water_last_error());
    else
        for (row = 0; row < ROWS; row++)
            printf("level %.4f 1/sr, drawn waves %.4f +- %.4f 1/sr\n", f[row], mean[row], spread[row]);

    prob_water_free(sea);
    prob_water_free(flat);
    prob_water_options_free(options);
    return failed;
}
