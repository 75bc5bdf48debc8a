#include "profile_codec.h"

static const struct profile_codec *const CODECS[] = {&PAPER_CODEC, &SPECTRAL_CODEC};

const struct profile_codec *profile_codec_find(enum profile profile)
{
	for (size_t i = 0; i < sizeof CODECS / sizeof *CODECS; i++)
		if (CODECS[i]->profile == profile)
			return CODECS[i];
	return NULL;
}

const struct profile_encoder *profile_codec_find_encoder(enum profile profile)
{
	static const struct profile_encoder *const ENCODERS[] = {&PAPER_ENCODER, &SPECTRAL_ENCODER};
	for (size_t i = 0; i < sizeof ENCODERS / sizeof *ENCODERS; i++)
		if (ENCODERS[i]->profile == profile)
			return ENCODERS[i];
	return NULL;
}
