/* A program of someone else's, in C and C++: prints how many materials an archive holds, after looking at and along each. */
#include <brdfpack.h>

#include <stdio.h>
#include <string.h>

/* 1: the material loads, evaluates to what a BRDF may be, and gives samples. */
static int material_works(const bp_archive *archive, uint64_t index, bp_error *error)
{
	const float wo[3] = {0.6f, 0, 0.8f}, u[3] = {0.5f, 0.25f, 0.75f};
	float wi[3], rgb[3];
	bp_load_options options;
	bp_material *material = NULL;
	int works = 0;

	memset(&options, 0, sizeof options);
	options.struct_bytes = sizeof options;
	options.form = BP_FORM_COMPACT;
	options.sampling = 1;
	if (bp_material_load(archive, index, &options, &material, error) != BP_OK)
		return 0;
	float pdf = bp_material_sample(material, wo, u, wi);
	bp_material_evaluate(material, wi, wo, rgb);
	works = pdf > 0 && pdf == bp_material_pdf(material, wi, wo) && rgb[0] >= 0 && rgb[1] >= 0 && rgb[2] >= 0;
	bp_material_albedo(material, 0.5f, rgb);
	works = works && rgb[1] >= 0;
	bp_material_free(material);
	strcpy(error->message, "values that no material has");
	return works;
}

int main(int argc, char **argv)
{
	bp_archive *archive = NULL;
	bp_material_info info;
	bp_error error;

	if (argc != 2)
		return 2;
	if (bp_archive_open(argv[1], &archive, &error) != BP_OK) {
		fprintf(stderr, "%s: %s\n", argv[1], error.message);
		return 1;
	}
	info.struct_bytes = sizeof info;
	for (uint64_t i = 0; i < bp_archive_count(archive); i++)
		if (bp_archive_info(archive, i, &info, &error) != BP_OK || info.record_bytes == 0 ||
		    !material_works(archive, i, &error)) {
			fprintf(stderr, "%s: %s\n", argv[1], error.message);
			return 1;
		}
	printf("%llu\n", (unsigned long long)bp_archive_count(archive));
	bp_archive_close(archive);
	return 0;
}
