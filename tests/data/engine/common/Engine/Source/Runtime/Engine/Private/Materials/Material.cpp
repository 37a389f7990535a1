// Stand-in for tests: which pins a material has. Not engine code.

#include "Material.h"

static bool IsPropertyActive_Internal(EMaterialProperty InProperty, bool bIsTranslucent, const FMaterialShadingModelField& ShadingModels)
{
	bool Active = true;
	switch (InProperty)
	{
	case MP_Opacity:
		Active = bIsTranslucent
			|| ShadingModels.HasShadingModel(MSM_Subsurface)
			|| ShadingModels.HasShadingModel(MSM_SingleLayerWater);
		break;
	case MP_Anisotropy:
		Active = ShadingModels.HasAnyShadingModel({ MSM_DefaultLit, MSM_ClearCoat }) && !bIsTranslucent;
		break;
	case MP_Tangent:
		Active = ShadingModels.HasAnyShadingModel({ MSM_DefaultLit, MSM_ClearCoat }) && !bIsTranslucent;
		break;
	case MP_CustomData0:
		Active = ShadingModels.HasAnyShadingModel({ MSM_ClearCoat, MSM_Hair, MSM_Cloth, MSM_Eye });
		break;
	case MP_CustomData1:
		Active = ShadingModels.HasAnyShadingModel({ MSM_ClearCoat, MSM_Eye });
		break;
	default:
		Active = ShadingModels.IsLit();
		break;
	}
	return Active;
}

bool IsPropertyActive(EMaterialProperty Property, const UMaterial& Material)
{
	return IsPropertyActive_Internal(Property, false, Material.GetShadingModels());
}
