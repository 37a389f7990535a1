// Stand-in for tests: what nodes do. Not engine code.

#include "CoreMinimal.h"
#include "MaterialCompiler.h"
#include "Materials/MaterialExpressionShadingModel.h"
#include "Materials/MaterialExpressionThinTranslucentMaterialOutput.h"

#define LOCTEXT_NAMESPACE "MaterialExpression"

UMaterialExpressionThinTranslucentMaterialOutput::UMaterialExpressionThinTranslucentMaterialOutput(const FObjectInitializer& ObjectInitializer)
	: Super(ObjectInitializer)
{
	Outputs.Reset();
}

FString UMaterialExpressionThinTranslucentMaterialOutput::GetFunctionName() const
{
	return TEXT("ThinTranslucent");
}

#undef LOCTEXT_NAMESPACE
