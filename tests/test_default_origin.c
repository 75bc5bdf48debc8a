/* test_default_origin.c: a table that was decoded from a record of the default profile gives that record's levels back. */
#include "values.h"

#include "codec/record.h"
#include "model/default_origin.h"
#include "model/fidelity.h"

static const struct lattice_dims DIMS = {60, 60, 40};
enum { WAVES = 40, BUDGET = 8000 }; /* binds */

static uint32_t state;
static double draw(void)
{
	state = state * 1664525 + 1013904223;
	return (state >> 8) * 0x1p-24;
}

/* Lobes and waves in the logarithm, another mixture in every channel, and a little of everything; as measured: not below the horizon. */
static void material_make(uint32_t seed, struct lattice *out)
{
	uint8_t *below = malloc(lattice_cells(DIMS));
	state = seed;
	double wave[WAVES][5];
	for (int w = 0; w < WAVES; w++)
		for (int n = 0; n < 5; n++)
			wave[w][n] = draw();
	assert_int_equal(lattice_alloc(DIMS, out, NULL), BP_OK);
	assert_int_equal(lattice_below_horizon(DIMS, 0, below, NULL), BP_OK);
	for (size_t at = 0; at < lattice_cells(DIMS); at++) {
		const double p = (double)(at % DIMS.phi_d) / DIMS.phi_d, d = (double)(at / DIMS.phi_d % DIMS.theta_d) / DIMS.theta_d;
		const double h = (double)(at / DIMS.phi_d / DIMS.theta_d) / DIMS.theta_h, lobe = 4 * exp(-30 * h * h) + 2 * d * d * d;
		double colour[3] = {0, 0.3, -0.2};
		for (int w = 0; w < WAVES; w++)
			for (int c = 0; c < 3; c++)
				colour[c] += 0.1 * (wave[w][3] + 0.3 * c * (wave[w][4] - 0.5)) * cos(2 * M_PI * (w % 10) * p) * cos(25 * wave[w][0] * h + 20 * wave[w][1] * d + 6 * wave[w][2]);
		for (int c = 0; c < 3; c++)
			out->rgb[c][at] = below[at] ? -1 : 0.2 * exp(lobe + colour[c] + 0.01 * draw());
	}
	free(below);
	lattice_validate(out);
}

struct packed {
	uint8_t *record;
	size_t bytes;
	struct record_head head;
	struct expansion table;
};

static void packed_make(const struct lattice *lattice, uint32_t budget, struct packed *out)
{
	const struct fit_options options = {.profile = PROFILE_DEFAULT, .budget_bytes = budget, .effort = 5};
	const struct record_source source = {.bytes = 1};
	struct model *model = NULL;

	assert_int_equal(record_pack(lattice, "m", &source, &options, &out->record, &out->bytes, &out->head, NULL), BP_OK);
	assert_int_equal(record_decode_whole(&out->head, 0, out->record, &model, NULL), BP_OK);
	assert_int_equal(expansion_alloc(lattice->dims, &out->table, NULL), BP_OK);
	assert_int_equal(model_expand(model, 0, &out->table, NULL), BP_OK);
	model_free(model);
}

static void packed_free(struct packed *packed)
{
	free(packed->record);
	expansion_free(&packed->table);
}

/* The decoded table, `scale` times as bright; below_horizon: without the cells that extraction leaves out. */
static void lattice_of(const struct packed *packed, double scale, bool below_horizon, struct lattice *out)
{
	const size_t cells = lattice_cells(DIMS);
	uint8_t *below = malloc(cells);

	assert_int_equal(lattice_alloc(DIMS, out, NULL), BP_OK);
	assert_int_equal(lattice_below_horizon(DIMS, 0, below, NULL), BP_OK);
	for (int c = 0; c < 3; c++)
		for (size_t i = 0; i < cells; i++)
			out->rgb[c][i] = below_horizon && below[i] ? -1 : scale * packed->table.unit * (double)packed->table.rgb[c][i];
	free(below);
	lattice_validate(out);
}

/* log RMSE of the table against those of the original's cells that `like` has. */
static double error_against(const struct lattice *original, const struct lattice *like, const struct packed *packed)
{
	struct lattice seen = *original;
	struct fidelity figures;

	seen.valid = like->valid;
	seen.valid_count = like->valid_count;
	assert_int_equal(fidelity_measure(&seen, &packed->table, &figures, NULL), BP_OK);
	return figures.log_rmse;
}

static double largest_difference(const struct packed *a, const struct packed *b, double scale)
{
	double worst = 0;
	for (int c = 0; c < 3; c++)
		for (size_t i = 0; i < lattice_cells(DIMS); i++) {
			const double x = scale * a->table.unit * (double)a->table.rgb[c][i], y = b->table.unit * (double)b->table.rgb[c][i];
			worst = fmax(worst, fabs(x - y) / x);
		}
	return worst;
}

/* Below the horizon the record continues what was measured; where nothing is cut off there, the unit is another statistic. */
static void a_whole_table_loses_next_to_nothing(void **unused)
{
	struct lattice original, decoded, scaled;
	struct packed first, second, third;
	(void)unused;
	material_make(1, &original);
	packed_make(&original, BUDGET, &first);
	assert_true(first.bytes > BUDGET * 95 / 100);
	lattice_of(&first, 1, false, &decoded);
	packed_make(&decoded, BUDGET, &second);
	assert_true(second.bytes <= BUDGET);
	/* 0.8 dB where the table is packed like a measurement */
	assert_true(20 * log10(error_against(&original, &original, &second) / error_against(&original, &original, &first)) < 0.05);
	lattice_of(&first, 37.5, false, &scaled);
	packed_make(&scaled, BUDGET, &third);
	assert_true(largest_difference(&second, &third, 37.5) < 1e-6);
	packed_free(&first);
	packed_free(&second);
	packed_free(&third);
	lattice_free(&original);
	lattice_free(&decoded);
	lattice_free(&scaled);
}

static void without_what_lies_below_the_horizon_little_is_lost(void **unused)
{
	(void)unused;
	for (uint32_t seed = 1; seed <= 2; seed++) {
		struct lattice original, decoded;
		struct packed first, packed;
		material_make(seed, &original);
		packed_make(&original, BUDGET, &first);
		lattice_of(&first, 1, true, &decoded);
		const double before = error_against(&original, &decoded, &first);
		for (int generation = 1; generation <= 2; generation++) {
			packed_make(&decoded, BUDGET, &packed);
			assert_true(packed.bytes <= BUDGET);
			/* 1.5 dB where the table is packed like a measurement */
			assert_true(20 * log10(error_against(&original, &decoded, &packed) / before) < 0.1 * generation);
			lattice_free(&decoded);
			lattice_of(&packed, 1, true, &decoded);
			packed_free(&packed);
		}
		packed_free(&first);
		lattice_free(&original);
		lattice_free(&decoded);
	}
}

static void another_budget_is_met_as_for_any_table(void **unused)
{
	struct lattice original, decoded;
	struct packed first, small, large;
	(void)unused;
	material_make(4, &original);
	packed_make(&original, BUDGET, &first);
	lattice_of(&first, 1, false, &decoded);
	packed_make(&decoded, BUDGET / 3, &small);
	assert_true(small.bytes <= BUDGET / 3 && small.bytes > BUDGET * 95 / 300);
	packed_make(&decoded, 2 * BUDGET, &large);
	assert_true(large.bytes <= 2 * BUDGET);
	assert_true(20 * log10(error_against(&original, &original, &large) / error_against(&original, &original, &first)) < 0.05);
	packed_free(&first);
	packed_free(&small);
	packed_free(&large);
	lattice_free(&original);
	lattice_free(&decoded);
}

/* Two values, noise, a material. (A constant lies on a grid, with nothing to lose.) */
static void what_was_never_decoded_shows_no_grid(void **unused)
{
	struct default_origin origin;
	struct spectrum *spectrum = NULL;
	const float base[3] = {0, 0, 0}, guess[3][3] = {{0.577350f, 0.577350f, 0.577350f}, {0.707107f, -0.707107f, 0}, {0.408248f, 0.408248f, -0.816497f}};
	(void)unused;
	assert_int_equal(spectrum_create(DIMS, &spectrum, NULL), BP_OK);
	for (int kind = 0; kind < 3; kind++) {
		struct lattice lattice;
		float *x[3];
		state = 7;
		if (kind == 2) {
			material_make(5, &lattice);
		} else {
			assert_int_equal(lattice_alloc(DIMS, &lattice, NULL), BP_OK);
			for (int c = 0; c < 3; c++)
				for (size_t i = 0; i < lattice_cells(DIMS); i++)
					lattice.rgb[c][i] = kind == 0 ? (i / 1000 % 2 ? 1 : 8) : exp(draw() * 3);
			lattice_validate(&lattice);
		}
		for (int c = 0; c < 3; c++) {
			x[c] = malloc(lattice_cells(DIMS) * sizeof(float));
			for (size_t i = 0; i < lattice_cells(DIMS); i++)
				x[c][i] = lattice.valid[i] ? (float)log2(1 + lattice.rgb[c][i] * 100) : 0;
			spectrum_forward(spectrum, x[c], 0);
		}
		assert_int_equal(default_origin_find(&lattice, x, base, guess, &origin, NULL), BP_OK);
		assert_true(origin.missed > 0.02);
		default_origin_free(&origin);
		for (int c = 0; c < 3; c++)
			free(x[c]);
		lattice_free(&lattice);
	}
	spectrum_free(spectrum);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_whole_table_loses_next_to_nothing),
		cmocka_unit_test(without_what_lies_below_the_horizon_little_is_lost),
		cmocka_unit_test(another_budget_is_met_as_for_any_table),
		cmocka_unit_test(what_was_never_decoded_shows_no_grid),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
