// Stand-in for tests: an expression that gives values to a shading model. Not engine code.
#pragma once

#include "MaterialExpressionIO.h"

class UMaterialExpression
{
public:
	explicit UMaterialExpression(const FObjectInitializer&) {}
	virtual ~UMaterialExpression() = default;
#if WITH_EDITOR
	virtual int32 Compile(class FMaterialCompiler*, int32) { return INDEX_NONE; }
	virtual void GetCaption(TArray<FString>&) const {}
#endif
#if WITH_EDITORONLY_DATA
	TArray<FText> MenuCategories;
#endif
	TArray<FExpressionOutput> Outputs;
	FString Desc;
};

class UMaterialExpressionCustomOutput : public UMaterialExpression
{
public:
	using UMaterialExpression::UMaterialExpression;
	virtual int32 GetNumOutputs() const { return 1; }
	virtual FString GetFunctionName() const { return FString(); }
	virtual FString GetDisplayName() const { return GetFunctionName(); }
};
