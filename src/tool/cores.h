/* cores.h: how many processor cores this process may use. */
#ifndef TOOL_CORES_H
#define TOOL_CORES_H

/* Processors that this process may use: its affinity mask, and the quota of its control group. */
unsigned cores_usable(void);

#endif
