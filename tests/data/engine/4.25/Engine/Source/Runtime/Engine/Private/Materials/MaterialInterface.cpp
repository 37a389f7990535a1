// Stand-in for tests: what a material is relevant to. Not engine code.

#include "Material.h"

bool GetRelevance_Internal(const UMaterial* Material)
{
	return Material->GetShadingModels().IsLit();
}
