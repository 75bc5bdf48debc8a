/* test_spectral_fit.c: what the spectral profile's fit owes to the scale and the order of its input. */
#include "values.h"

#include "model/spectral/spectral.h"

static uint32_t state = 1;
static double draw(void)
{
	state = state * 1664525 + 1013904223;
	return (state >> 8) * 0x1p-24;
}

/* A coloured lobe with some noise; a seventh of the cells is not there. */
static void lattice_make(struct lattice_dims dims, struct lattice *out)
{
	assert_int_equal(lattice_alloc(dims, out, NULL), BP_OK);
	for (size_t n = 0; n < lattice_cells(dims); n++) {
		const double h = (double)(n / dims.phi_d / dims.theta_d) / dims.theta_h, lobe = 50 * exp(-20 * h * h);
		for (int c = 0; c < 3; c++)
			out->rgb[c][n] = n % 7 == 3 ? -1 : (0.02 * (c + 1) + lobe / (1 + c)) * (1 + 0.1 * draw());
	}
	lattice_validate(out);
}

/* The same, with values multiplied by s and channel c as channel (c + turn) % 3. */
static void lattice_changed(const struct lattice *from, double s, int turn, struct lattice *out)
{
	assert_int_equal(lattice_alloc(from->dims, out, NULL), BP_OK);
	for (int c = 0; c < 3; c++)
		for (size_t n = 0; n < lattice_cells(from->dims); n++)
			out->rgb[(c + turn) % 3][n] = from->valid[n] ? s * from->rgb[c][n] : -1;
	lattice_validate(out);
}

static void decoded(const struct lattice *lattice, struct expansion *out)
{
	const struct fit_options options = {.profile = PROFILE_SPECTRAL, .budget_bytes = 3000, .effort = 5};
	const struct record_source source = {.bytes = 1};
	struct record_head head;
	struct model *model = NULL;
	uint8_t *record;
	size_t bytes;
	assert_int_equal(record_encode(lattice, "m", &source, &options, &record, &bytes, &head, NULL), BP_OK);
	assert_int_equal(record_decode_whole(&head, 0, record, &model, NULL), BP_OK);
	assert_int_equal(expansion_alloc(lattice->dims, out, NULL), BP_OK);
	assert_int_equal(model_expand(model, 0, out, NULL), BP_OK);
	model_free(model);
	free(record);
}

static const struct lattice_dims DIMS = {20, 18, 14};

static void a_table_multiplied_decodes_to_its_values_multiplied(void **unused)
{
	static const double scales[] = {1e-290, 1e-12, 3.3e-7, 0x1p-20, 0.1, 0.7, 3, 1e3, 7.7e8, 1e12, 1e300};
	struct lattice lattice;
	struct expansion once;
	(void)unused;
	lattice_make(DIMS, &lattice);
	decoded(&lattice, &once);
	for (size_t s = 0; s < sizeof scales / sizeof *scales; s++) {
		struct lattice multiplied;
		struct expansion other;
		lattice_changed(&lattice, scales[s], 0, &multiplied);
		decoded(&multiplied, &other);
		for (int c = 0; c < 3; c++)
			for (size_t n = 0; n < lattice_cells(DIMS); n++) {
				const double wanted = scales[s] * (once.unit * (double)once.rgb[c][n]);
				if (!(fabs(other.unit * (double)other.rgb[c][n] - wanted) <= 1e-12 * wanted))
					fail_msg("times %g: channel %d, cell %zu: %g, not %g", scales[s], c, n, other.unit * (double)other.rgb[c][n],
					         wanted);
			}
		lattice_free(&multiplied);
		expansion_free(&other);
	}
	expansion_free(&once);
	lattice_free(&lattice);
}

static void channels_may_change_places(void **unused)
{
	struct lattice lattice;
	struct expansion once;
	(void)unused;
	lattice_make(DIMS, &lattice);
	decoded(&lattice, &once);
	for (int turn = 1; turn < 3; turn++) {
		struct lattice turned;
		struct expansion other;
		lattice_changed(&lattice, 1, turn, &turned);
		decoded(&turned, &other);
		assert_true(once.unit == other.unit);
		for (int c = 0; c < 3; c++)
			assert_memory_equal(once.rgb[c], other.rgb[(c + turn) % 3], lattice_cells(DIMS) * sizeof(float));
		lattice_free(&turned);
		expansion_free(&other);
	}
	expansion_free(&once);
	lattice_free(&lattice);
}

/* The unit of a table with these values, one after the other, the same in all channels. */
static double unit_of(const double *value, size_t count)
{
	const struct fit_options options = {.profile = PROFILE_SPECTRAL, .budget_bytes = 3000, .effort = 5};
	struct lattice lattice;
	struct model *model = NULL;
	assert_int_equal(lattice_alloc((struct lattice_dims){4, 5, 5}, &lattice, NULL), BP_OK);
	for (int c = 0; c < 3; c++)
		for (size_t n = 0; n < 100; n++)
			lattice.rgb[c][n] = value[n % count];
	lattice_validate(&lattice);
	assert_int_equal(model_fit(&lattice, &options, &model, NULL), BP_OK);
	const double unit = model->spectral->unit;
	model_free(model);
	lattice_free(&lattice);
	return unit;
}

static void the_unit_is_a_hundredth_of_the_middle(void **unused)
{
	double value[100];
	(void)unused;
	for (int i = 0; i < 100; i++)
		value[i] = i + 1;
	/* Of 300 values, each three times: the 150th and the 255th, counted from 1. */
	assert_true(fabs(unit_of(value, 100) - sqrt(50.0 * 85.0) / 100) < 1e-14);
}

static void units_of_degenerate_tables_are_as_documented(void **unused)
{
	const double zero = 0, one = 1, bright = 1e300, dark = 1e-300, tiny = 5e-324;
	double single[100] = {0}, half[100];
	(void)unused;
	assert_true(unit_of(&zero, 1) == 1);
	assert_true(fabs(unit_of(&one, 1) - 0.01) < 1e-17);
	assert_true(fabs(unit_of(&bright, 1) / 1e298 - 1) < 1e-15);
	assert_true(fabs(unit_of(&dark, 1) / 1e-302 - 1) < 1e-15);
	assert_true(unit_of(&tiny, 1) == SPECTRAL_UNIT_LEAST);
	single[37] = 1e12;
	assert_true(fabs(unit_of(single, 100) / (1e12 * 0x1p-24 / 100) - 1) < 1e-15);
	for (int i = 0; i < 100; i++)
		half[i] = i < 60 ? 0 : 4;
	assert_true(fabs(unit_of(half, 100) / (4 * 0x1p-12 / 100) - 1) < 1e-15);
}

/* Nothing else is known of the table: one cell in its last slice decodes to itself everywhere. */
static void a_single_valid_cell_is_the_whole_table(void **unused)
{
	struct lattice lattice;
	struct expansion table;
	const size_t cells = lattice_cells(DIMS);
	(void)unused;
	assert_int_equal(lattice_alloc(DIMS, &lattice, NULL), BP_OK);
	for (int c = 0; c < 3; c++)
		for (size_t n = 0; n < cells; n++)
			lattice.rgb[c][n] = n == cells - 1 ? 0.1 * (c + 1) : -1;
	lattice_validate(&lattice);
	decoded(&lattice, &table);
	for (int c = 0; c < 3; c++)
		for (size_t n = 0; n < cells; n++)
			assert_true(fabs(table.unit * (double)table.rgb[c][n] / (0.1 * (c + 1)) - 1) < 1e-5);
	expansion_free(&table);
	lattice_free(&lattice);
}

/* A model that was fitted holds coefficients, of which a record keeps what its budget allows: nobody asks for its values. */
static void only_a_decoded_model_has_values(void **unused)
{
	const struct fit_options options = {.profile = PROFILE_SPECTRAL, .budget_bytes = 3000, .effort = 5};
	struct lattice lattice;
	struct model *model = NULL;
	struct expansion table = {0}, half = {0};
	(void)unused;
	lattice_make((struct lattice_dims){20, 18, 14}, &lattice);
	assert_int_equal(model_fit(&lattice, &options, &model, NULL), BP_OK);
	assert_int_equal(model_expand(model, 0, &table, NULL), BP_ERROR_ARGUMENT);
	assert_int_equal(model_expand_half(model, &half, NULL), BP_ERROR_ARGUMENT);
	expansion_free(&table);
	expansion_free(&half);
	model_free(model);
	lattice_free(&lattice);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_table_multiplied_decodes_to_its_values_multiplied),
		cmocka_unit_test(channels_may_change_places),
		cmocka_unit_test(the_unit_is_a_hundredth_of_the_middle),
		cmocka_unit_test(units_of_degenerate_tables_are_as_documented),
		cmocka_unit_test(a_single_valid_cell_is_the_whole_table),
		cmocka_unit_test(only_a_decoded_model_has_values),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
