#include "build_state.h"

#include "tool/interrupt.h"
#include "tool/report.h"

bool build_goes_on(const struct build *build)
{
	return !build->stopped && !interrupt_signal();
}

void build_stop(struct build *build, const char *file, const char *material, const bp_error *error)
{
	report_error(file, material, error);
	build->stopped = true;
}
