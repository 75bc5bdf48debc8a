/*
 * stress_checks.h: the properties of a packed stress material, each noted as a figure of its trial.
 */
#ifndef TESTS_STRESS_CHECKS_H
#define TESTS_STRESS_CHECKS_H

#include "stress_subject.h"
#include "stress_trial.h"

void checks_run(const struct trial *trial, const struct packed_table *packed);

#endif
