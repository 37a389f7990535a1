// Stand-in for tests: a material and what it is made of. Not engine code.
#pragma once

#include "MaterialCompiler.h"

enum EMaterialDomain
{
	MD_Surface,
	MD_Volume
};

enum EMaterialProperty
{
	MP_Metallic,
	MP_Specular,
	MP_Roughness,
	MP_Anisotropy,
	MP_Opacity,
	MP_Tangent,
	MP_CustomData0,
	MP_CustomData1,
	MP_AmbientOcclusion,
	MP_ShadingModel,
	MP_MAX
};

class UMaterial
{
public:
	FMaterialShadingModelField GetShadingModels() const { return ShadingModels; }
	EMaterialDomain MaterialDomain = MD_Surface;
	FMaterialShadingModelField ShadingModels;
};

class FMaterialAttributeDefintion
{
public:
	int32 CompileDefaultValue(FMaterialCompiler* Compiler);
	EMaterialProperty Property = MP_MAX;
	FVector4 DefaultValue = {};
};

class FMaterialAttributeDefinitionMap
{
public:
	static FText GetAttributeOverrideForMaterial(EMaterialProperty Property, UMaterial* Material);
};
