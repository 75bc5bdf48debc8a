/* test_sphere.c: where a pixel looks in a table, and what it sees there. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>
#include <cmocka.h>

#include "render/sphere.h"

static const struct lattice_dims SMALL = {4, 5, 6};

/* Cell coordinates by the textbook's rotations (Rusinkiewicz 1998): wi and wo in the frame where the normal is z. */
static void textbook_coordinates(struct lattice_dims dims, const double i[3], const double o[3], double at[3])
{
	double h[3] = {i[0] + o[0], i[1] + o[1], i[2] + o[2]}, s = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
	double theta_h = acos(fmin(1, h[2] / s)), phi_h = atan2(h[1], h[0]);
	/* rotate wi by -phi_h about z, then by -theta_h about y */
	double x = cos(phi_h) * i[0] + sin(phi_h) * i[1], y = -sin(phi_h) * i[0] + cos(phi_h) * i[1];
	double dx = cos(theta_h) * x - sin(theta_h) * i[2], dz = sin(theta_h) * x + cos(theta_h) * i[2];
	double phi_d = atan2(y, dx);
	phi_d = phi_d < 0 ? phi_d + M_PI : phi_d;
	at[0] = sqrt(theta_h / M_PI_2) * dims.theta_h;
	at[1] = acos(fmin(1, dz)) / M_PI_2 * dims.theta_d;
	at[2] = fmod(phi_d / M_PI * dims.phi_d, dims.phi_d);
}

static double textbook_look_up(const struct lattice *lattice, const double at[3], int c)
{
	struct lattice_dims d = lattice->dims;
	/* from the first centre on; before it, and beyond the last one, the value stays */
	double h = fmin(fmax(at[0] - 0.5, 0), d.theta_h - 1), t = fmin(fmax(at[1] - 0.5, 0), d.theta_d - 1), sum = 0;
	double p = fmod(at[2] - 0.5 + d.phi_d, d.phi_d);
	for (uint32_t neighbour = 0; neighbour < 8; neighbour++) {
		uint32_t i = (uint32_t)h, j = (uint32_t)t, k = (uint32_t)p;
		double w =
			(neighbour & 1 ? h - i : 1 - (h - i)) * (neighbour & 2 ? t - j : 1 - (t - j)) * (neighbour & 4 ? p - k : 1 - (p - k));
		i += neighbour & 1;
		j += (neighbour & 2) >> 1;
		k = (k + (neighbour >> 2)) % d.phi_d;
		if (w > 0)
			sum += w * lattice->rgb[c][lattice_index(d, i, j, k)];
	}
	return sum;
}

static void lattice_make(struct lattice_dims dims, struct lattice *lattice)
{
	bp_error error;
	assert_int_equal(lattice_alloc(dims, lattice, &error), BP_OK);
	srand(7);
	for (int c = 0; c < 3; c++)
		for (size_t n = 0; n < lattice_cells(dims); n++)
			lattice->rgb[c][n] = 0.25 + (rand() % 1000) * 1e-3;
	lattice_validate(lattice);
}

static void random_direction(double v[3])
{
	double z = (1 + rand() % 1000) / 1001.0, phi = (rand() % 6283) * 1e-3, r = sqrt(1 - z * z);
	v[0] = r * cos(phi);
	v[1] = r * sin(phi);
	v[2] = z;
}

/* Unit vector from the surface point with normal n to the light; returns the irradiance at normal incidence. */
static double light_towards(const struct light *light, const double n[3], double d[3])
{
	double square = 0;
	memcpy(d, light->at, 3 * sizeof *d);
	if (!light->is_point)
		return light->weight;
	for (int q = 0; q < 3; q++) {
		d[q] -= n[q];
		square += d[q] * d[q];
	}
	for (int q = 0; q < 3; q++)
		d[q] /= sqrt(square);
	return light->weight / square;
}

static void textbook_pixel(const struct lattice *lattice, const struct light *lights, int count, double u, double v,
                           double sum[3])
{
	/* a frame with the normal as pole; isotropy makes its turn about the pole free */
	double w = sqrt(1 - u * u - v * v), r = sqrt(u * u + v * v), ez[3] = {u, v, w};
	double ex[3] = {r > 1e-9 ? w * u / r : 1, r > 1e-9 ? w * v / r : 0, -r};
	double ey[3] = {r > 1e-9 ? -v / r : 0, r > 1e-9 ? u / r : 1, 0};
	sum[0] = sum[1] = sum[2] = 0;
	for (int l = 0; l < count; l++) {
		double d[3], at[3], irradiance = light_towards(&lights[l], ez, d);
		double i[3] = {0, 0, 0}, o[3] = {ex[2], ey[2], ez[2]};
		for (int q = 0; q < 3; q++) {
			i[0] += ex[q] * d[q];
			i[1] += ey[q] * d[q];
			i[2] += ez[q] * d[q];
		}
		if (i[2] <= 1e-3)
			continue;
		textbook_coordinates(lattice->dims, i, o, at);
		for (int c = 0; c < 3; c++)
			sum[c] += textbook_look_up(lattice, at, c) * i[2] * irradiance;
	}
}

static void the_sphere_agrees_with_the_textbook_under_every_lighting(void **state)
{
	(void)state;
	enum { SIZE = 9 };
	bp_error error;
	struct lattice lattice;
	struct lookup_table table;
	struct sphere_image image;
	struct light lights[LIGHTS_MAX];
	lattice_make(SMALL, &lattice);
	assert_int_equal(lookup_table_measured(&lattice, &table, &error), BP_OK);
	assert_int_equal(sphere_image_alloc(SIZE, &image, &error), BP_OK);
	for (int lighting = 0; lighting < LIGHTING_COUNT; lighting++) {
		int count = lights_make((enum lighting)lighting, lights);
		assert_int_equal(sphere_render((enum lighting)lighting, &table, &image, &error), BP_OK);
		for (int n = 0; n < SIZE * SIZE; n++) {
			double u = (n % SIZE + 0.5) / SIZE * 2 - 1, v = 1 - (n / SIZE + 0.5) / SIZE * 2, sum[3] = {0, 0, 0};
			assert_int_equal(image.covered[n], u * u + v * v < 0.99);
			if (image.covered[n])
				textbook_pixel(&lattice, lights, count, u, v, sum);
			for (int c = 0; c < 3; c++)
				assert_true(fabs((double)image.rgb[3 * n + c] - sum[c]) <= 3e-5 * sum[c]);
		}
	}
	sphere_image_free(&image);
	lookup_table_free(&table);
	lattice_free(&lattice);
}

/* The bound that lookup.h states, and 16 bits of fraction. */
static void places_agree_with_inverse_trigonometric_functions(void **state)
{
	(void)state;
	struct angle_tables *angles = angle_tables_make();
	assert_non_null(angles);
	srand(3);
	for (int n = 0; n < 100000; n++) {
		double i[3], o[3], at[3];
		random_direction(i);
		random_direction(o);
		if (n % 3 == 0) { /* close to the mirror direction, where theta_h is small */
			i[0] = -o[0] + 1e-3 * (n % 7);
			i[1] = -o[1];
			i[2] = sqrt(fmax(0, 1 - i[0] * i[0] - i[1] * i[1]));
		}
		double h[3] = {i[0] + o[0], i[1] + o[1], i[2] + o[2]}, s = sqrt(h[0] * h[0] + h[1] * h[1] + h[2] * h[2]);
		double cos_h = h[2] / s, cos_d = (i[0] * h[0] + i[1] * h[1] + i[2] * h[2]) / s;
		if (cos_h > 1 - 1e-9 || cos_d > 1 - 1e-9 || i[2] <= 0)
			continue; /* acos itself loses half its digits at 1 */
		textbook_coordinates(LATTICE_MERL, i, o, at);
		struct place place =
			place_make(angles, LATTICE_MERL, cos_h, cos_d, (i[1] * h[0] - i[0] * h[1]) / s, cos_d * cos_h - i[2], 1);
		double cell_i = place.cell / 181 % 91 + place.theta_h / 65535.0, cell_j = place.cell / 181 / 91 + place.theta_d / 65535.0;
		double cell_k = place.cell % 181 + place.phi_d / 65535.0, around = fabs(cell_k + 0.5 - at[2]);
		/* counted from the first centre; beyond the last one there is a copy, which place_make may lean on */
		assert_true(fabs(cell_i - fmax(at[0] - 0.5, 0)) < 2e-5);
		assert_true(fabs(cell_j - fmax(at[1] - 0.5, 0)) < 2e-5);
		assert_true(fmin(around, 180 - around) < 2e-5);
	}
	free(angles);
}

static void phi_d_is_periodic_and_the_ends_are_clamped(void **state)
{
	(void)state;
	bp_error error;
	struct lattice lattice;
	struct lookup_table table;
	struct angle_tables *angles = angle_tables_make();
	assert_non_null(angles);
	assert_int_equal(lattice_alloc(SMALL, &lattice, &error), BP_OK);
	/* R = 1 in the first cell of phi_d; G = i, the cell along theta_h; B = j, along theta_d */
	for (size_t n = 0; n < lattice_cells(SMALL); n++) {
		lattice.rgb[0][n] = n % 6 == 0;
		lattice.rgb[1][n] = (double)(n / 30);
		lattice.rgb[2][n] = (double)(n / 6 % 5);
	}
	lattice_validate(&lattice);
	assert_int_equal(lookup_table_measured(&lattice, &table, &error), BP_OK);

	/* phi_d a quarter cell before pi: 5.75 of 6 cells, a quarter of the way from the last centre to the first */
	double phi = M_PI * 5.75 / 6;
	struct place place = place_make(angles, SMALL, 1, 1, sin(phi), cos(phi), 1);
	assert_true(fabs((double)place_look_up(&place, &table)[0] - 0.25) < 1e-4);
	/* a quarter cell after 0: three quarters of that way */
	phi = M_PI * 0.25 / 6;
	place = place_make(angles, SMALL, 1, 1, sin(phi), cos(phi), 1);
	assert_true(fabs((double)place_look_up(&place, &table)[0] - 0.75) < 1e-4);
	/* the same direction, named by the opposite angle */
	place = place_make(angles, SMALL, 1, 1, -sin(phi), -cos(phi), 2);
	assert_true(fabs((double)place_look_up(&place, &table)[0] - 2 * 0.75) < 2e-4);
	/* theta_h = theta_d = 90 degrees: the last cells */
	place = place_make(angles, SMALL, 0, 0, 0, 1, 1);
	float4 value = place_look_up(&place, &table);
	assert_true(fabs((double)value[1] - 3) < 1e-5 && fabs((double)value[2] - 4) < 1e-5);
	/* three cells of four and four of five along: half-way between centres 2 and 3, 3 and 4 */
	place = place_make(angles, SMALL, cos(M_PI_2 * 3 * 3 / 16), cos(M_PI_2 * 4 / 5), 0, 1, 1);
	value = place_look_up(&place, &table);
	assert_true(fabs((double)value[1] - 2.5) < 1e-4 && fabs((double)value[2] - 3.5) < 1e-4);
	/* theta_h = theta_d = 0, and half-way to the first centres: the first cells */
	place = place_make(angles, SMALL, 1, 1, 0, 1, 1);
	value = place_look_up(&place, &table);
	assert_true(value[1] == 0 && value[2] == 0);
	place = place_make(angles, SMALL, cos(M_PI_2 * 0.25 * 0.25 / 16), cos(M_PI_2 * 0.25 / 5), 0, 1, 1);
	value = place_look_up(&place, &table);
	assert_true(value[1] == 0 && value[2] == 0);
	free(angles);
	lookup_table_free(&table);
	lattice_free(&lattice);
}

static void invalid_cells_are_black_in_both_tables(void **state)
{
	(void)state;
	bp_error error;
	struct lattice lattice;
	struct expansion expansion;
	struct lookup_table measured, decoded;
	lattice_make(SMALL, &lattice);
	lattice.rgb[1][17] = -1;
	lattice_validate(&lattice);
	assert_int_equal(expansion_alloc(SMALL, &expansion, &error), BP_OK);
	expansion.unit = 0.5;
	for (int c = 0; c < 3; c++)
		for (size_t n = 0; n < lattice_cells(SMALL); n++)
			expansion.rgb[c][n] = 3;
	assert_int_equal(lookup_table_measured(&lattice, &measured, &error), BP_OK);
	assert_int_equal(lookup_table_decoded(&expansion, lattice.valid, measured.unit, &decoded, &error), BP_OK);
	/* cell 17 = (0, 2, 5): stored [j][i][k] with rows of 7 and slices of 5 rows */
	size_t at = 4 * (5 + 7 * (0 + 5 * 2));
	for (size_t c = 0; c < 3; c++) {
		assert_true(measured.cells[at + c] == 0 && decoded.cells[at + c] == 0);
		assert_true(measured.cells[at - 4 + c] > 0 && decoded.cells[at - 4 + c] == 1.5f);
	}
	lookup_table_free(&decoded);
	assert_int_equal(lookup_table_decoded(&expansion, lattice.valid, 0, &decoded, &error), BP_OK);
	assert_true(decoded.cells[at - 4] == 3 && decoded.unit == 0.5);
	lookup_table_free(&measured);
	lookup_table_free(&decoded);
	expansion_free(&expansion);
	lattice_free(&lattice);
}

static void values_of_any_magnitude_render_finite(void **state)
{
	(void)state;
	static const double FACTORS[] = {1e300, 1, 1e-300};
	bp_error error;
	struct sphere_image image;
	assert_int_equal(sphere_image_alloc(3, &image, &error), BP_OK);
	for (int f = 0; f < 3; f++) {
		struct lattice lattice;
		struct lookup_table table;
		lattice_make(SMALL, &lattice);
		for (int c = 0; c < 3; c++)
			for (size_t n = 0; n < lattice_cells(SMALL); n++)
				lattice.rgb[c][n] *= FACTORS[f];
		assert_int_equal(lookup_table_measured(&lattice, &table, &error), BP_OK);
		assert_int_equal(sphere_render(LIGHTING_KEY, &table, &image, &error), BP_OK);
		double middle = (double)image.rgb[3 * 4];
		assert_true(middle > 1e-3 && middle < 1e3 && image.unit == table.unit);
		lookup_table_free(&table);
		lattice_free(&lattice);
	}
	sphere_image_free(&image);
}

static void a_band_of_rows_gives_the_rows_of_the_whole(void **state)
{
	(void)state;
	enum { SIZE = 12 };
	bp_error error;
	struct lattice lattice;
	struct lookup_table table;
	struct sphere_image whole, bands;
	struct sphere_plan *plan;
	lattice_make(SMALL, &lattice);
	assert_int_equal(lookup_table_measured(&lattice, &table, &error), BP_OK);
	assert_int_equal(sphere_image_alloc(SIZE, &whole, &error), BP_OK);
	assert_int_equal(sphere_image_alloc(SIZE, &bands, &error), BP_OK);
	const struct lookup_table *tables[2] = {&table, &table};
	struct sphere_image *both[2] = {&whole, &bands}, *second[1] = {&bands};
	assert_int_equal(sphere_plan_make(LIGHTING_KEY, SIZE, 0, SIZE, SMALL, &plan, &error), BP_OK);
	sphere_plan_render(plan, tables, 2, both);
	assert_memory_equal(whole.rgb, bands.rgb, 3 * SIZE * SIZE * sizeof(float));
	sphere_plan_free(plan);
	memset(bands.rgb, 0xff, 3 * SIZE * SIZE * sizeof(float));
	for (uint32_t y = 0; y < SIZE; y += 5) {
		assert_int_equal(sphere_plan_make(LIGHTING_KEY, SIZE, y, y + 5 < SIZE ? 5 : SIZE - y, SMALL, &plan, &error), BP_OK);
		sphere_plan_render(plan, tables, 1, second);
		sphere_plan_free(plan);
	}
	assert_memory_equal(whole.rgb, bands.rgb, 3 * SIZE * SIZE * sizeof(float));
	sphere_image_free(&whole);
	sphere_image_free(&bands);
	lookup_table_free(&table);
	lattice_free(&lattice);
}

static void sizes_out_of_range_are_refused(void **state)
{
	(void)state;
	bp_error error;
	struct sphere_image image;
	struct sphere_plan *plan;
	assert_int_equal(sphere_image_alloc(0, &image, &error), BP_ERROR_ARGUMENT);
	assert_int_equal(sphere_image_alloc(100000, &image, &error), BP_ERROR_ARGUMENT);
	assert_non_null(strstr(error.message, "1 to 4096"));
	assert_int_equal(sphere_plan_make(LIGHTING_KEY, 0, 0, 0, SMALL, &plan, &error), BP_ERROR_ARGUMENT);
	assert_int_equal(sphere_plan_make(LIGHTING_KEY, 10, 8, 3, SMALL, &plan, &error), BP_ERROR_ARGUMENT);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(the_sphere_agrees_with_the_textbook_under_every_lighting),
		cmocka_unit_test(places_agree_with_inverse_trigonometric_functions),
		cmocka_unit_test(phi_d_is_periodic_and_the_ends_are_clamped),
		cmocka_unit_test(invalid_cells_are_black_in_both_tables),
		cmocka_unit_test(values_of_any_magnitude_render_finite),
		cmocka_unit_test(a_band_of_rows_gives_the_rows_of_the_whole),
		cmocka_unit_test(sizes_out_of_range_are_refused),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
