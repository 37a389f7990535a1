// Stand-in for tests: what a shader is compiled with. Not engine code.
#pragma once

#include "CoreMinimal.h"

struct FShaderCompilerEnvironment
{
	void SetDefine(const TCHAR*, const TCHAR*) {}
};
