// Stand-in for tests: what a static mesh takes part in. Not engine code.

#include "Material.h"

bool HasDraws(const UMaterial& Material)
{
	return Material.GetShadingModels().IsLit();
}
