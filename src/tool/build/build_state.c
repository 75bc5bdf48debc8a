#include "build_state.h"

#include "name.h"
#include "tool/interrupt.h"
#include "tool/report.h"

bool build_goes_on(const struct build *build) { return !build->stopped && !interrupt_signal(); }

void build_stop(struct build *build, const char *file, const bp_error *error)
{
	report_error(file, NULL, error);
	build->stopped = true;
}

bool build_shard_has(const struct build_options *options, const char *name)
{
	return options->shard_count <= 1 || name_shard(name, options->shard_count) == options->shard;
}
