// Stand-in for tests. Not engine code.
#pragma once

#define ENGINE_MAJOR_VERSION	4
#define ENGINE_MINOR_VERSION	27
#define ENGINE_PATCH_VERSION	2
