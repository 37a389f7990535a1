// Stand-in for tests: the shading models of a material. Not engine code.

#pragma once

#include "CoreMinimal.h"
#include "UObject/ObjectMacros.h"

/** A material's shading model; its number is the id in shaders. */
UENUM()
enum EMaterialShadingModel
{
	MSM_Unlit					UMETA(DisplayName="Unlit"),
	MSM_DefaultLit				UMETA(DisplayName="Default Lit"),
	MSM_Subsurface				UMETA(DisplayName="Subsurface"),
	MSM_PreintegratedSkin		UMETA(DisplayName="Preintegrated Skin"),
	MSM_ClearCoat				UMETA(DisplayName="Clear Coat"),
	MSM_SubsurfaceProfile		UMETA(DisplayName="Subsurface Profile"),
	MSM_TwoSidedFoliage			UMETA(DisplayName="Two Sided Foliage"),
	MSM_Hair					UMETA(DisplayName="Hair"),
	MSM_Cloth					UMETA(DisplayName="Cloth"),
	MSM_Eye						UMETA(DisplayName="Eye"),
	MSM_SingleLayerWater		UMETA(DisplayName="SingleLayerWater"),
	MSM_ThinTranslucent			UMETA(DisplayName="Thin Translucent"),
	/** Number of unique shading models. */
	MSM_NUM						UMETA(Hidden),
	/** The material's graph decides. */
	MSM_FromMaterialExpression	UMETA(DisplayName="From Material Expression"),
	MSM_MAX
};

static_assert(MSM_NUM <= 16, "a field of shading models has 16 bits");

/** The shading models that a material may have, as bits. */
struct FMaterialShadingModelField
{
	void AddShadingModel(EMaterialShadingModel Model) { Bits |= static_cast<uint16>(1 << Model); }
	bool HasShadingModel(EMaterialShadingModel Model) const { return (Bits & (1 << Model)) != 0; }
	bool HasOnlyShadingModel(EMaterialShadingModel Model) const { return Bits == (1 << Model); }
	bool HasAnyShadingModel(const TArray<EMaterialShadingModel>& Models) const
	{
		for (EMaterialShadingModel Model : Models)
		{
			if (HasShadingModel(Model))
			{
				return true;
			}
		}
		return false;
	}
	bool IsLit() const { return !HasOnlyShadingModel(MSM_Unlit); }

private:
	uint16 Bits = 0;
};
