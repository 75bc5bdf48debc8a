#include "profile_codec.h"

const struct profile_codec *profile_codec_find(enum profile profile)
{
	return profile == PROFILE_PAPER ? &PAPER_CODEC : profile == PROFILE_SPECTRAL ? &SPECTRAL_CODEC : NULL;
}

profile_encode_fn *profile_encoder_find(enum profile profile)
{
	return profile == PROFILE_PAPER ? paper_encode : profile == PROFILE_SPECTRAL ? spectral_encode : NULL;
}
