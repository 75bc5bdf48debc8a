/* The MERL reader on arbitrary bytes, with any extents, and what is done with a record that the file carries. */
#include <float.h>
#include <stdlib.h>
#include <string.h>

#include "codec/record_carried.h"
#include "merl/merl_file.h"

struct input {
	const uint8_t *bytes;
	size_t left;
};

/* In odd portions, as a pipe gives them. */
static bp_status input_read(void *user, void *bytes, size_t capacity, size_t *read, bp_error *error)
{
	struct input *input = user;
	(void)error;
	*read = capacity < input->left ? capacity : input->left;
	*read = *read > 1000 ? 1000 : *read;
	memcpy(bytes, input->bytes, *read);
	input->bytes += *read;
	input->left -= *read;
	return BP_OK;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count);
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t count)
{
	struct input input = {data, count};
	struct lattice lattice;
	struct carried carried = {0};
	if (lattice_read(input_read, &input, &(struct merl_reading){.any_dims = true, .carried = &carried}, &lattice, NULL) != BP_OK)
		return 0;
	for (size_t i = 0; i < lattice_cells(lattice.dims); i++)
		for (int c = 0; c < 3; c++)
			if (lattice.valid[i] && !(lattice.rgb[c][i] >= 0 && lattice.rgb[c][i] <= DBL_MAX))
				abort();
	for (int p = PROFILE_PAPER; p <= PROFILE_SPECTRAL; p++) {
		const struct fit_options options = {(enum profile)p, 60400, 0, 5};
		uint8_t *record;
		size_t bytes;
		if (record_carried(&lattice, &carried, "m", &options, &record, &bytes, NULL) == BP_OK)
			free(record);
	}
	lattice_free(&lattice);
	free(carried.bytes);
	return 0;
}
