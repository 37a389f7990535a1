// Stand-in for tests: what expressions compile with. Not engine code.
#pragma once

#include "Engine/EngineTypes.h"

enum EMaterialValueType
{
	MCT_Float1 = 1,
	MCT_Float2 = 2,
	MCT_Float3 = 4,
	MCT_Float4 = 8
};

class UMaterialExpressionCustomOutput;

class FMaterialCompiler
{
public:
	virtual ~FMaterialCompiler() = default;
	virtual int32 Constant(float X) = 0;
	virtual int32 Constant2(float X, float Y) = 0;
	virtual int32 Constant3(float X, float Y, float Z) = 0;
	virtual int32 Constant4(float X, float Y, float Z, float W) = 0;
	virtual int32 ForceCast(int32 Code, EMaterialValueType DestType, uint32 ForceCastFlags = 0) = 0;
	virtual int32 CustomOutput(class UMaterialExpressionCustomOutput* Custom, int32 OutputIndex, int32 OutputCode) = 0;
	virtual FMaterialShadingModelField GetMaterialShadingModels() const = 0;
};
