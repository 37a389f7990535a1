// Stand-in for tests: what a material is relevant to. Not engine code.

#include "Material.h"

bool GetRelevance_Internal(const UMaterial* Material)
{
	const FMaterialShadingModelField ShadingModels = Material->GetShadingModels();
	const bool bUsesAnisotropy = ShadingModels.HasAnyShadingModel({ MSM_DefaultLit, MSM_ClearCoat });
	return bUsesAnisotropy;
}
