/* table_build_model: tables straight from a model, beside those made by way of an expansion. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdlib.h>

#include <cmocka.h>

#include "codec/record.h"
#include "model/table/table.h"
#include "packed_fixture.h"
#include "trilinear.h"

static void directions(int n, float wi[3], float wo[3])
{
	double a = 0.1 + n * 0.37, b = n * 1.71, c = fmod(n * 0.61, 1.5), d = fmod(n * 0.83, 1.5);
	wi[0] = (float)(sin(c) * cos(a)), wi[1] = (float)(sin(c) * sin(a)), wi[2] = (float)cos(c);
	wo[0] = (float)(sin(d) * cos(b)), wo[1] = (float)(sin(d) * sin(b)), wo[2] = (float)cos(d);
}

/* Packs and decodes a coloured lobe. */
static struct model *model_make(enum profile profile, struct lattice_dims dims, double unit)
{
	const struct fit_options options = {.profile = profile, .budget_bytes = 60400, .effort = 5};
	const struct record_source source = {.bytes = 1};
	struct lattice lattice;
	struct record_head head;
	struct model *model = NULL;
	uint8_t *record = NULL;
	size_t bytes;
	glossy_lattice_make(dims, unit, &lattice);
	assert_int_equal(record_encode(&lattice, "x", &source, &options, &record, &bytes, &head, NULL), BP_OK);
	assert_int_equal(record_decode_whole(&head, 0, record, &model, NULL), BP_OK);
	lattice_free(&lattice);
	free(record);
	return model;
}

static void same_values(const struct model *model, enum table_form form, int channels)
{
	struct table *direct = NULL, *by_way = NULL;
	struct expansion expansion;
	assert_int_equal(expansion_alloc(model->dims, &expansion, NULL), BP_OK);
	assert_int_equal(model_expand(model, 0, &expansion, NULL), BP_OK);
	assert_int_equal(table_build(&expansion, form, channels, &by_way, NULL), BP_OK);
	assert_int_equal(table_build_model(model, false, form, channels, &direct, NULL), BP_OK);
	assert_int_equal(table_bytes(direct), table_bytes(by_way));
	for (int m = 0; m < 300; m++) {
		float wi[3], wo[3], a[3], b[3];
		directions(m, wi, wo);
		table_evaluate(direct, wi, wo, a);
		table_evaluate(by_way, wi, wo, b);
		assert_memory_equal(a, b, sizeof a);
		assert_true(a[0] >= 0);
	}
	expansion_free(&expansion);
	table_free(direct);
	table_free(by_way);
}

/* Of every second value: between them, and where one stands, which is where it stands in the whole table. */
static void half_values(const struct model *model, enum table_form form, int channels)
{
	const double within = form == TABLE_EXPANDED ? 0x1p-11 + 1e-4 : 0.01;
	struct lattice_dims dims;
	struct table *half = NULL, *whole = NULL;
	struct expansion expansion;
	float wi[3], wo[3], a[3], b[3];
	int seen = 0;
	if (!model_has_half(model->dims, &dims)) {
		assert_int_equal(table_build_model(model, true, form, channels, &half, NULL), BP_ERROR_ARGUMENT);
		return;
	}
	assert_int_equal(expansion_alloc(dims, &expansion, NULL), BP_OK);
	assert_int_equal(model_expand_half(model, &expansion, NULL), BP_OK);
	assert_int_equal(table_build_model(model, true, form, channels, &half, NULL), BP_OK);
	assert_int_equal(table_build_model(model, false, form, channels, &whole, NULL), BP_OK);
	double most = 0; /* beside it a value near 0 is rounded as its neighbours are */
	for (size_t n = 0; n < lattice_cells(dims); n++)
		most = fmax(most, expansion.unit * (double)expansion.rgb[1][n]);
	for (int m = 0; m < 300; m++) {
		struct lattice_point at;
		directions(m, wi, wo);
		assert_true(direction_to_lattice(dims, wi, wo, &at));
		table_evaluate(half, wi, wo, a);
		double want = trilinear(&expansion, 1, at, 0.25);
		if (channels == 1)
			want = (trilinear(&expansion, 0, at, 0.25) + want + trilinear(&expansion, 2, at, 0.25)) / 3;
		assert_true(fabs((double)a[1] - want) <= within * (want + 1e-3 * most));
	}
	for (uint32_t i = 0; i < dims.theta_h; i++)
		for (uint32_t j = 0; j < dims.theta_d; j++)
			for (uint32_t k = 0; k < dims.phi_d; k++) {
				if (!directions_at(model->dims, 2 * i + 0.5, 2 * j + 0.5, 2 * k + 0.5, wi, wo))
					continue;
				seen++;
				table_evaluate(half, wi, wo, a);
				table_evaluate(whole, wi, wo, b);
				assert_true(fabsf(a[1] - b[1]) <= 2 * (float)(within * ((double)b[1] + 1e-3 * most)));
			}
	assert_true(seen > 100);
	expansion_free(&expansion);
	table_free(half);
	table_free(whole);
}

static void a_table_of_a_model_is_that_of_its_expansion_and_a_half_one_has_every_second_value_where_it_stood(void **state)
{
	static const struct lattice_dims DIMS[] = {{24, 20, 48}, {17, 16, 19}, {16, 18, 8}};
	static const double UNITS[] = {1, 1e7, 1e-5, 1e200};
	(void)state;
	for (int n = 0; n < 12; n++)
		for (int profile = PROFILE_PAPER; profile <= PROFILE_SPECTRAL; profile++) {
			struct model *model = model_make((enum profile)profile, DIMS[n % 3], UNITS[n / 3]);
			for (int channels = 1; channels <= 3; channels += 2)
				for (int form = 0; form < 2; form++) {
					same_values(model, (enum table_form)form, channels);
					if (UNITS[n / 3] < TABLE_LARGEST) /* beyond, tables are cut */
						half_values(model, (enum table_form)form, channels);
				}
			model_free(model);
		}
}

static void forms_and_channels_that_do_not_exist_are_refused(void **state)
{
	struct model *model = model_make(PROFILE_SPECTRAL, (struct lattice_dims){8, 8, 8}, 1);
	struct table *table = NULL;
	(void)state;
	assert_int_equal(table_build_model(model, false, TABLE_EXPANDED, 2, &table, NULL), BP_ERROR_ARGUMENT);
	assert_int_equal(table_build_model(model, false, (enum table_form)7, 3, &table, NULL), BP_ERROR_ARGUMENT);
	model_free(model);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(a_table_of_a_model_is_that_of_its_expansion_and_a_half_one_has_every_second_value_where_it_stood),
		cmocka_unit_test(forms_and_channels_that_do_not_exist_are_refused),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
