// Stand-in for tests: how a shading model is called in logs. Not engine code.

#include "Material.h"

FString GetShadingModelString(EMaterialShadingModel Model)
{
	FString ShadingModelName;
	switch (Model)
	{
		case MSM_Unlit:			ShadingModelName = TEXT("MSM_Unlit"); break;
		case MSM_DefaultLit:	ShadingModelName = TEXT("MSM_DefaultLit"); break;
		default: ShadingModelName = TEXT("Unknown"); break;
	}
	return ShadingModelName;
}

int32 UpdateMaterialShaderCompilingStats(const UMaterial* Material)
{
	const FMaterialShadingModelField ShadingModels = Material->GetShadingModels();
	int32 NumLit = 0;
	if (ShadingModels.HasAnyShadingModel({ MSM_DefaultLit, MSM_Subsurface, MSM_ClearCoat, MSM_Cloth }))
	{
		++NumLit;
	}
	return NumLit;
}
