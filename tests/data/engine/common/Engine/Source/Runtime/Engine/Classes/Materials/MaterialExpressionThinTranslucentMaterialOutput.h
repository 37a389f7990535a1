// Stand-in for tests: a node with one input. Not engine code.

#pragma once

#include "Materials/MaterialExpressionCustomOutput.h"
#include "MaterialExpressionThinTranslucentMaterialOutput.generated.h"

UCLASS()
class UMaterialExpressionThinTranslucentMaterialOutput : public UMaterialExpressionCustomOutput
{
	GENERATED_UCLASS_BODY()

	UPROPERTY()
	FExpressionInput TransmittanceColor;

	virtual FString GetFunctionName() const override;
};
