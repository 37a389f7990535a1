// Stand-in for tests: which materials have an anisotropy pass. Not engine code.

#include "Material.h"

bool IsAnisotropyPassCompatible(const UMaterial& Material)
{
	const FMaterialShadingModelField ShadingModels = Material.GetShadingModels();
	return ShadingModels.HasAnyShadingModel({ MSM_DefaultLit, MSM_ClearCoat });
}

void AddMeshBatch(const UMaterial& Material, int32& OutDraws)
{
	const FMaterialShadingModelField ShadingModels = Material.GetShadingModels();
	if (ShadingModels.HasAnyShadingModel({ MSM_DefaultLit, MSM_ClearCoat }))
	{
		++OutDraws;
	}
}
