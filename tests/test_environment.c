/*
 * A host that set another rounding mode, or has denormals flushed: packing, loading, tables and kept albedos are the same to the bit.
 * One that traps exceptions meets none.
 */
#include "archive_fixture.h"

#include <fenv.h>
#include <sys/wait.h>
#if defined __x86_64__
#include <xmmintrin.h>
#endif

#include "held_archive.h"
#include "packed_fixture.h"

enum { CELLS = 24 * 20 * 48, MODES = 5 };

static const int MODE[4] = {FE_TONEAREST, FE_DOWNWARD, FE_UPWARD, FE_TOWARDZERO};

/* Mode 4: to nearest, denormals flushed on the way in and out, where the processor has it. */
static void mode_set(int mode)
{
	assert_int_equal(fesetround(MODE[mode % 4]), 0);
#if defined __x86_64__
	if (mode == 4)
		_mm_setcsr(_mm_getcsr() | 0x8040);
#endif
}

static int mode_is(int mode)
{
#if defined __x86_64__
	if (((_mm_getcsr() & 0x8040) == 0x8040) != (mode == 4))
		return 0;
#endif
	return fegetround() == MODE[mode % 4];
}

static uint32_t crc_of(uint32_t crc, const void *bytes, size_t count) { return bytes_crc32_more(crc, bytes, count); }

/*
 * What comes of packing and loading, as checksums: record, tables, and, evaluated in the usual mode, values, samples and albedos.
 * In a process of its own: what a library keeps from its first call on would hide what the mode does to it.
 */
static uint32_t figures_in_mode(int mode, const double *planes, uint32_t profile)
{
	const bp_measured measured = {
		.struct_bytes = sizeof measured, .theta_h = 24, .theta_d = 20, .phi_d = 48, .number = BP_NUMBER_DOUBLE, .values = planes};
	const bp_pack_options packing = {.struct_bytes = sizeof packing, .profile = profile};
	bp_material *material[3] = {0};
	uint8_t *record = NULL;
	size_t record_bytes;
	float *table = malloc(3 * CELLS * sizeof *table), rgb[3];
	uint32_t crc = 0;

	mode_set(mode);
	assert_int_equal(bp_pack(&measured, "a", &packing, &record, &record_bytes, NULL), BP_OK);
	assert_true(mode_is(mode));
	struct held held = held_of(record, record_bytes);
	assert_int_equal(bp_archive_table(held.archive, 0, NULL, table, 3 * CELLS * sizeof *table, NULL), BP_OK);
	for (int form = 0; form < 3; form++) {
		const bp_load_options options = {.struct_bytes = sizeof options, .form = (bp_form)form, .sampling = 1};
		assert_int_equal(bp_material_load(held.archive, 0, &options, &material[form], NULL), BP_OK);
		bp_material_albedo(material[form], 0.7f, rgb); /* kept from now on */
	}
	assert_true(mode_is(mode));
	fesetenv(FE_DFL_ENV);
	crc = crc_of(crc, held.bytes, held.count);
	crc = crc_of(crc, table, 3 * CELLS * sizeof *table);
	for (int form = 0; form < 3; form++) {
		for (int n = 0; n < 200; n++) {
			const float a = 0.007f * (float)n, wo[3] = {sinf(a), 0, cosf(a)}, u[3] = {0.005f * (float)n, 0.3f, 0.6f};
			float wi[3];
			const float pdf = bp_material_sample(material[form], wo, u, wi);
			crc = crc_of(crc_of(crc, wi, sizeof wi), &pdf, sizeof pdf);
			bp_material_evaluate(material[form], wi, wo, rgb);
			crc = crc_of(crc, rgb, sizeof rgb);
		}
		bp_material_albedo(material[form], 0.7f, rgb);
		crc = crc_of(crc, rgb, sizeof rgb);
		bp_material_free(material[form]);
	}
	held_free(&held);
	bp_free(record);
	free(table);
	return crc;
}

static uint32_t figures_in_child(int mode, const double *planes, uint32_t profile)
{
	int pipe_ends[2], code;
	uint32_t crc = 0;
	assert_int_equal(pipe(pipe_ends), 0);
	const pid_t child = fork();
	if (child == 0) {
		crc = figures_in_mode(mode, planes, profile);
		_exit(write(pipe_ends[1], &crc, sizeof crc) == (ssize_t)sizeof crc ? 0 : 1);
	}
	assert_int_equal(waitpid(child, &code, 0), child);
	assert_int_equal(code, 0);
	assert_int_equal(read(pipe_ends[0], &crc, sizeof crc), sizeof crc);
	close(pipe_ends[0]);
	close(pipe_ends[1]);
	return crc;
}

static void bits_do_not_depend_on_the_callers_mode(void **state)
{
	struct lattice lattice;
	double *planes = malloc(3 * CELLS * sizeof *planes);
	(void)state;
	glossy_lattice_make((struct lattice_dims){24, 20, 48}, 1, &lattice);
	for (size_t c = 0; c < 3; c++)
		for (size_t n = 0; n < CELLS; n++)
			/* some values beyond a float's normal range */
			planes[n + c * CELLS] = n % 11 == 2 ? 0x1p-1040 * (double)n : n % 13 == 5 ? -1 : lattice.rgb[c][n];
	for (uint32_t profile = 1; profile <= 2; profile++) {
		const uint32_t expected = figures_in_child(0, planes, profile);
		for (int mode = 1; mode < MODES; mode++)
			assert_int_equal(figures_in_child(mode, planes, profile), expected);
	}
	free(planes);
	lattice_free(&lattice);
}

/* Who hunts for NaNs has exceptions trapped: whatever decodes must not stop there, be it at a number that was rounded. */
static void exceptions_that_the_caller_traps_are_not_met_in_decoding(void **state)
{
	struct lattice lattice;
	struct record_head head;
	const struct fit_options packing = {.profile = PROFILE_SPECTRAL, .budget_bytes = 8000, .effort = 1};
	const struct record_source source = {.bytes = 1};
	uint8_t *record = NULL;
	float *table = malloc(3 * CELLS * sizeof *table);
	size_t record_bytes;
	int code;
	(void)state;
	glossy_lattice_make((struct lattice_dims){24, 20, 48}, 1, &lattice);
	assert_int_equal(record_encode(&lattice, "a", &source, &packing, &record, &record_bytes, &head, NULL), BP_OK);
	struct held held = held_of(record, record_bytes);
	const pid_t child = fork();
	if (child == 0) {
		const bp_load_options options = {.struct_bytes = sizeof options, .sampling = 1};
		bp_material *material = NULL;
		feenableexcept(FE_ALL_EXCEPT);
		const int failed = bp_archive_table(held.archive, 0, NULL, table, 3 * CELLS * sizeof *table, NULL) ||
		                   bp_material_load(held.archive, 0, &options, &material, NULL) ||
		                   bp_archive_verify(held.archive, BP_VERIFY_DEEP, NULL, NULL, NULL);
		_exit(failed);
	}
	assert_int_equal(waitpid(child, &code, 0), child);
	assert_int_equal(code, 0);
	held_free(&held);
	free(record);
	free(table);
	lattice_free(&lattice);
}

int main(void)
{
	const struct CMUnitTest tests[] = {
		cmocka_unit_test(bits_do_not_depend_on_the_callers_mode),
		cmocka_unit_test(exceptions_that_the_caller_traps_are_not_met_in_decoding),
	};
	return cmocka_run_group_tests(tests, NULL, NULL);
}
