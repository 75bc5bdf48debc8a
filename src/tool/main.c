#include "brdfpack.h"

int main(void)
{
	return 0;
}
