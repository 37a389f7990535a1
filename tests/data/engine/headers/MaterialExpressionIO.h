// Stand-in for tests: what an expression's pins are. Not engine code.
#pragma once

#include "UObject/ObjectMacros.h"

class FMaterialCompiler;

struct FExpressionInput
{
	int32 Compile(FMaterialCompiler* Compiler) { return Compiler != nullptr ? 0 : INDEX_NONE; }
	bool IsConnected() const { return Expression != nullptr; }
	class UMaterialExpression* Expression = nullptr;
};

struct FExpressionOutput
{
	FString OutputName;
};
