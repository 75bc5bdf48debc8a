/* A program of someone else's: prints how many materials an archive holds, after looking at each. */
#include <brdfpack.h>

#include <stdio.h>

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
		if (bp_archive_info(archive, i, &info, &error) != BP_OK || info.record_bytes == 0) {
			fprintf(stderr, "%s: %s\n", argv[1], error.message);
			return 1;
		}
	printf("%llu\n", (unsigned long long)bp_archive_count(archive));
	bp_archive_close(archive);
	return 0;
}
