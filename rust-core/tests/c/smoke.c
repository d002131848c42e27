/* The C interface used as a C programmer would: configure, evaluate, sample, and every refusal. */
#include "prob_water.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static int failures = 0;

static void check(int holds, const char *what) {
    if (!holds) {
        failures++;
        printf("FAILED: %s (%s)\n", what, prob_water_last_error());
    }
}

/* By the setter. */
static void refuses(const char *name, const char *value) {
    struct ProbWaterOptions *options = prob_water_options_new();
    check(prob_water_options_set(options, name, value) == PROB_WATER_STATUS_PARAMETER, name);
    check(strstr(prob_water_last_error(), name) != NULL, "the message names the parameter");
    check(strstr(prob_water_last_error(), value) != NULL || strcmp(name, "waves") == 0, "the message names the value");
    prob_water_options_free(options);
}

/* By the setter, which leaves the earlier value. */
static void refuses_number(const char *name, double value) {
    struct ProbWaterOptions *options = prob_water_options_new();
    struct ProbWater *sea = NULL;
    check(prob_water_options_set_number(options, name, 2) == PROB_WATER_STATUS_OK, name);
    check(prob_water_options_set_number(options, name, value) == PROB_WATER_STATUS_PARAMETER, name);
    check(strstr(prob_water_last_error(), name) != NULL, "the message names the parameter");
    check(strstr(prob_water_last_error(), "allowed is") != NULL, "the message names the range");
    check(prob_water_configure(options, &sea) == PROB_WATER_STATUS_OK, "the earlier value stays");
    prob_water_free(sea);
    prob_water_options_free(options);
}

/* Values that are allowed but hardly meant. */
static void warnings(void) {
    struct ProbWaterOptions *options = prob_water_options_new();
    struct ProbWater *sea = NULL;
    check(prob_water_configure(options, &sea) == PROB_WATER_STATUS_OK, "defaults");
    check(strcmp(prob_water_warnings(sea), "") == 0, "nothing to warn of");
    prob_water_free(sea);
    check(prob_water_options_set_number(options, "wind_direction", 1e9) == PROB_WATER_STATUS_OK, "any azimuth");
    check(prob_water_options_set_number(options, "footprint", 0.0002) == PROB_WATER_STATUS_OK, "any footprint");
    check(prob_water_configure(options, &sea) == PROB_WATER_STATUS_OK, "configure");
    check(strncmp(prob_water_warnings(sea), "wind_direction = 1000000000", 27) == 0, "the azimuth is told");
    check(strstr(prob_water_warnings(sea), "\nfootprint = 0.0002") != NULL, "and the footprint");
    check(prob_water_warnings(NULL) == NULL, "no sea, no warnings");
    prob_water_free(sea);
    prob_water_options_free(options);
}

/* The empirical model: a table's mean with its uncertainty. */
static void empirical(void) {
    struct ProbWaterOptions *options = prob_water_options_new();
    struct ProbWater *sea = NULL, *flat = NULL;
    /* Mirrors at 30 degrees and overhead; at 87 degrees, outside of the table; below the horizon. */
    const double s = 0.99862953475457387, c = 0.052335956242943835;
    double to_source[12] = {-0.5, 0, 0.8660254037844386, 0, 0, 1, -0.99862953475457387, 0, 0.052335956242943835, 0, 0, 1};
    double to_observer[12] = {0.5, 0, 0.8660254037844386, 0, 0, 1, 0, 0, 1, 0, 0, -1};
    double normals[12] = {0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, uniforms[3] = {0.3, 0.6, 0.1}, drawn[3];
    double mean[4], spread[4], f[4], pdf[4], density;
    unsigned char outside[4];

    to_observer[6] = s;
    to_observer[8] = c;
    check(prob_water_options_set(options, "friction_velocity", "8") == PROB_WATER_STATUS_OK, "wind");
    check(prob_water_configure(options, &flat) == PROB_WATER_STATUS_OK, "a flat sea");
    check(prob_water_options_set(options, "surface", "empirical") == PROB_WATER_STATUS_OK, "empirical");
    check(prob_water_configure(options, &sea) == PROB_WATER_STATUS_OK, "the library's own table");
    check(prob_water_estimate(sea, 4, to_source, to_observer, mean, spread, outside) == PROB_WATER_STATUS_OK, "estimate");
    check(mean[0] > 0.1 && mean[0] < 0.2 && spread[0] > 0.05 && spread[0] < 0.2, "the base scenario's peak");
    check(mean[3] == 0 && spread[3] == 0, "nothing from below");
    check(!outside[0] && !outside[1] && outside[2] && !outside[3], "outside of the grid is told");
    check(prob_water_eval(sea, 4, to_source, to_observer, NULL, f) == PROB_WATER_STATUS_OK, "eval");
    check(fabs(f[0] / mean[0] - 1) < 1e-12 && fabs(f[2] / mean[2] - 1) < 1e-12, "eval is the mean");
    check(prob_water_eval(sea, 4, to_source, to_observer, normals, f) == PROB_WATER_STATUS_ARGUMENT, "normals");
    check(prob_water_estimate(flat, 1, to_source, to_observer, mean, spread, outside) == PROB_WATER_STATUS_ARGUMENT,
          "a flat sea has no estimate");
    check(prob_water_sample(sea, 1, to_source, uniforms, drawn, pdf, f) == PROB_WATER_STATUS_OK, "sample");
    check(prob_water_pdf(sea, 1, to_source, drawn, NULL, &density) == PROB_WATER_STATUS_OK, "pdf");
    check(prob_water_estimate(sea, 1, to_source, drawn, mean, spread, outside) == PROB_WATER_STATUS_OK, "estimate of it");
    check(density == pdf[0] && fabs(f[0] / mean[0] - 1) < 1e-12, "sample, pdf and estimate agree");
    prob_water_free(sea);
    sea = NULL;
    check(prob_water_options_set(options, "table", "/nowhere/table.npz") == PROB_WATER_STATUS_OK, "a table by its path");
    check(prob_water_configure(options, &sea) == PROB_WATER_STATUS_PARAMETER && sea == NULL, "no such file");
    check(strstr(prob_water_last_error(), "table = /nowhere/table.npz") != NULL, "the message names it");
    prob_water_options_free(options);
    options = prob_water_options_new();
    check(prob_water_options_set(options, "surface", "empirical") == PROB_WATER_STATUS_OK, "surface");
    check(prob_water_options_set(options, "components", "20") == PROB_WATER_STATUS_OK, "components");
    check(prob_water_configure(options, &sea) == PROB_WATER_STATUS_PARAMETER && sea == NULL, "another sea than the table's");
    check(strstr(prob_water_last_error(), "components = 20") != NULL, "the message names what differs");
    prob_water_options_free(options);
    prob_water_free(flat);
}

int main(void) {
    struct ProbWaterOptions *options = prob_water_options_new();
    struct ProbWater *sea = NULL;
    struct ProbWaterSummary summary;
    /* The first three rows: overhead, mirror at 45 degrees, below the horizon. */
    const double r = 0.70710678118654752;
    double to_source[9] = {0, 0, 1, -0.70710678118654752, 0, 0.70710678118654752, 0, 0, 1};
    double to_observer[9] = {0, 0, 1, 0.70710678118654752, 0, 0.70710678118654752, 0, 0, -1};
    double normals[9] = {0, 0, 1, 0, 0, 1, 0, 0, 1};
    double f[3], g[3], pdf[3], drawn[9];
    double uniforms[9] = {0.1, 0.2, 0.3, 0.5, 0.5, 0.5, 0.99, 0.01, 0.7};
    float source32[3] = {0, 0, 1}, f32;

    check(prob_water_options_set_number(options, "friction_velocity", 8.0) == PROB_WATER_STATUS_OK, "set number");
    check(prob_water_options_set(options, "footprint", "inf") == PROB_WATER_STATUS_OK, "set text");
    check(prob_water_options_set(options, "ior", "1.33") == PROB_WATER_STATUS_OK, "set ior");
    check(prob_water_configure(options, &sea) == PROB_WATER_STATUS_OK, "configure");
    check(strcmp(prob_water_last_error(), "") == 0, "no message after success");
    check(prob_water_summary(sea, &summary) == PROB_WATER_STATUS_OK, "summary");
    check(fabs(summary.wind_speed_10 - 2.0065407395637957) < 1e-12, "wind at 10 m");
    check(fabs(summary.ior - 1.33) < 1e-15, "index");

    check(prob_water_eval(sea, 3, to_source, to_observer, NULL, f) == PROB_WATER_STATUS_OK, "eval");
    check(f[0] > 0.05 && f[0] < 1 && f[1] > f[0] && f[2] == 0, "values");
    check(prob_water_eval(sea, 3, to_source, to_observer, normals, g) == PROB_WATER_STATUS_OK, "eval with normals");
    check(memcmp(f, g, sizeof f) == 0, "a flat sea's normals are up");
    {
        double matrices[48];
        check(prob_water_mueller(sea, 3, to_source, to_observer, NULL, matrices) == PROB_WATER_STATUS_OK, "matrices");
        check(matrices[0] == f[0] && matrices[16] == f[1] && matrices[32] == 0, "the first element is f");
        check(matrices[17] < 0 && matrices[17] == matrices[20] && matrices[18] == 0, "parallel light is reflected least");
        check(prob_water_mueller(sea, 3, to_source, to_observer, NULL, NULL) == PROB_WATER_STATUS_ARGUMENT, "no place for them");
    }
    check(prob_water_eval_f32(sea, 1, source32, source32, NULL, &f32) == PROB_WATER_STATUS_OK, "float32");
    check(fabs(f32 / f[0] - 1) < 1e-5, "float32 agrees");
    {
        const float x[3] = {0, -0.70710678f, 0}, xo[3] = {0, 0.70710678f, 0}, y[3] = {0, 0, 0}, z[3] = {1, 0.70710678f, 1},
                    zo[3] = {1, 0.70710678f, -1};
        const float *source[3] = {x, y, z}, *observer[3] = {xo, y, zo};
        float many[3];
        check(prob_water_eval_columns(sea, 3, source, observer, NULL, many) == PROB_WATER_STATUS_OK, "columns");
        check(fabs(many[0] / f[0] - 1) < 1e-5 && fabs(many[1] / f[1] - 1) < 1e-5 && many[2] == 0, "columns agree");
        {
            float zeros[3] = {0, 0, 0}, ones[3] = {1, 1, 1}, again[3];
            const float *normal[3] = {zeros, zeros, ones};
            check(prob_water_eval_columns(sea, 3, source, observer, normal, again) == PROB_WATER_STATUS_OK, "column normals");
            check(fabs(again[1] / many[1] - 1) < 1e-5 && again[2] == 0, "upright normals change nothing");
        }
        source[1] = NULL;
        check(prob_water_eval_columns(sea, 3, source, observer, NULL, many) == PROB_WATER_STATUS_ARGUMENT, "a null column");
        source[1] = x;
        check(prob_water_eval_columns(sea, 3, source, observer, NULL, many) == PROB_WATER_STATUS_ROW, "columns not unit");
        check(strstr(prob_water_last_error(), "row 2") != NULL, "names the row");
    }
    check(prob_water_sample(sea, 3, to_source, uniforms, drawn, pdf, f) == PROB_WATER_STATUS_OK, "sample");
    check(prob_water_pdf(sea, 3, to_source, drawn, NULL, g) == PROB_WATER_STATUS_OK, "pdf");
    check(memcmp(pdf, g, sizeof pdf) == 0, "sample and pdf agree");
    check(prob_water_eval(sea, 0, NULL, NULL, NULL, NULL) == PROB_WATER_STATUS_OK, "no rows");

    to_observer[3] = 0.8;
    f[0] = -7;
    check(prob_water_eval(sea, 3, to_source, to_observer, NULL, f) == PROB_WATER_STATUS_ROW, "not unit");
    check(strstr(prob_water_last_error(), "row 2") != NULL && f[0] == -7, "names the row and writes nothing");
    to_observer[3] = NAN;
    check(prob_water_eval(sea, 3, to_source, to_observer, NULL, f) == PROB_WATER_STATUS_ROW, "not finite");
    to_observer[3] = r;
    normals[2] = -1;
    check(prob_water_eval(sea, 3, to_source, to_observer, normals, f) == PROB_WATER_STATUS_ROW, "normal points down");
    uniforms[4] = 1;
    check(prob_water_sample(sea, 3, to_source, uniforms, drawn, pdf, f) == PROB_WATER_STATUS_ROW, "uniform of 1");
    check(prob_water_eval(NULL, 1, to_source, to_observer, NULL, f) == PROB_WATER_STATUS_ARGUMENT, "null handle");
    check(prob_water_eval(sea, 1, NULL, to_observer, NULL, f) == PROB_WATER_STATUS_ARGUMENT, "null array");
    check(prob_water_configure(NULL, &sea) == PROB_WATER_STATUS_ARGUMENT, "null options");
    check(prob_water_options_set(options, "beaufort", "4") == PROB_WATER_STATUS_PARAMETER, "two winds");

    refuses("friction_velocity", "-1");
    refuses("wind_speed", "NaN");
    refuses("wind_speed", "60");
    refuses_number("wind_speed", NAN);
    refuses_number("wind_speed", -1);
    refuses_number("wind_direction", INFINITY);
    refuses_number("footprint", NAN);
    refuses_number("footprint", 0);
    refuses_number("components", 0);
    refuses_number("seed", -1);
    refuses_number("time", NAN);
    refuses_number("depth", -5);
    refuses_number("wavelength", 0.1);
    refuses_number("ior", 9);
    {
        /* How much of a wind speed is too much its height decides, which may come later. */
        struct ProbWaterOptions *high = prob_water_options_new();
        struct ProbWater *there = NULL;
        check(prob_water_options_set_number(high, "wind_speed", 40) == PROB_WATER_STATUS_OK, "40 m/s somewhere");
        check(prob_water_configure(high, &there) == PROB_WATER_STATUS_PARAMETER && there == NULL, "but not at 10 m");
        check(prob_water_options_set_number(high, "wind_height", 100) == PROB_WATER_STATUS_OK, "height");
        check(prob_water_configure(high, &there) == PROB_WATER_STATUS_OK, "at 100 m");
        prob_water_free(there);
        prob_water_options_free(high);
    }
    warnings();
    refuses("footprint", "0");
    refuses("footprint", "-2");
    refuses("beaufort", "13");
    refuses("ior", "0.9");
    refuses("surface", "lumpy");
    refuses("depth", "shallow");
    refuses("whitecaps", "maybe");
    refuses("waves", "3");

    empirical();

    prob_water_free(sea);
    prob_water_free(NULL);
    prob_water_options_free(options);
    prob_water_options_free(NULL);
    if (failures == 0)
        printf("C interface: all checks passed\n");
    return failures != 0;
}
