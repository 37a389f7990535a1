// Stand-in for tests: what a static mesh takes part in. Not engine code.

#include "Material.h"

bool HasAnisotropyDraws(const UMaterial& Material)
{
	return Material.GetShadingModels().HasAnyShadingModel({MSM_DefaultLit, MSM_ClearCoat});
}
