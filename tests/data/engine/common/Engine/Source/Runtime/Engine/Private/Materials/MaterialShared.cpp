// Stand-in for tests: names and defaults of pins. Not engine code.

#include "Material.h"

static FString GetPinNameFromShadingModelField(FMaterialShadingModelField Field, const TArray<TKeyValuePair<EMaterialShadingModel, FString>>& CustomPinNames, const FString& DefaultPinName)
{
	for (const TKeyValuePair<EMaterialShadingModel, FString>& Name : CustomPinNames)
	{
		if (Field.HasShadingModel(Name.Key))
		{
			return Name.Value;
		}
	}
	return DefaultPinName;
}

int32 FMaterialAttributeDefintion::CompileDefaultValue(FMaterialCompiler* Compiler)
{
	if (Property == MP_AmbientOcclusion && Compiler->GetMaterialShadingModels().HasOnlyShadingModel(MSM_TwoSidedFoliage))
	{
		return Compiler->Constant(1.0f);
	}

	if (Property == MP_ShadingModel)
	{
		return INDEX_NONE;
	}
	return Compiler->Constant4(DefaultValue.X, DefaultValue.Y, DefaultValue.Z, DefaultValue.W);
}

FText FMaterialAttributeDefinitionMap::GetAttributeOverrideForMaterial(EMaterialProperty Property, UMaterial* Material)
{
	TArray<TKeyValuePair<EMaterialShadingModel, FString>> CustomPinNames;

	switch (Property)
	{
	case MP_Opacity:
		return LOCTEXT("Opacity", "Opacity");
	case MP_Metallic:
		return LOCTEXT("Metallic", "Metallic");
	case MP_Specular:
		return LOCTEXT("Specular", "Specular");
	case MP_Anisotropy:
		return LOCTEXT("Anisotropy", "Anisotropy");
	case MP_AmbientOcclusion:
		return LOCTEXT("AmbientOcclusion", "Ambient Occlusion");
	case MP_CustomData0:
		CustomPinNames.Add({MSM_ClearCoat, "Clear Coat"});
		CustomPinNames.Add({MSM_Hair, "Backlit"});
		return FText::FromString(GetPinNameFromShadingModelField(Material->GetShadingModels(), CustomPinNames, "Custom Data 0"));
	case MP_CustomData1:
		CustomPinNames.Add({MSM_ClearCoat, "Clear Coat Roughness"});
		return FText::FromString(GetPinNameFromShadingModelField(Material->GetShadingModels(), CustomPinNames, "Custom Data 1"));
	default:
		return LOCTEXT("None", "None");
	}
}
