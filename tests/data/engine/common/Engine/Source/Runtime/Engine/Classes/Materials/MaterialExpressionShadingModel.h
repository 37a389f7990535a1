// Stand-in for tests: the node that chooses a shading model. Not engine code.

#pragma once

#include "Engine/EngineTypes.h"
#include "Materials/MaterialExpressionCustomOutput.h"

UCLASS()
class UMaterialExpressionShadingModel : public UMaterialExpression
{
public:
	UPROPERTY(EditAnywhere, Category=ShadingModel, meta=(ValidEnumValues="MSM_DefaultLit, MSM_Subsurface, MSM_ClearCoat, MSM_Cloth, MSM_Eye"))
	TEnumAsByte<EMaterialShadingModel> ShadingModel = MSM_DefaultLit;
};
