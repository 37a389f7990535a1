// Stand-in for tests: what a material's shader is compiled with. Not engine code.

#include "Material.h"
#include "ShaderCore.h"

void GetMaterialEnvironment(const UMaterial& Material, FShaderCompilerEnvironment& OutEnvironment)
{
	const FMaterialShadingModelField ShadingModels = Material.GetShadingModels();
	int NumSetMaterials = 0;
	if (ShadingModels.HasShadingModel(MSM_DefaultLit))
	{
		OutEnvironment.SetDefine(TEXT("MATERIAL_SHADINGMODEL_DEFAULT_LIT"), TEXT("1"));
		NumSetMaterials++;
	}
	if (ShadingModels.HasShadingModel(MSM_SingleLayerWater))
	{
		OutEnvironment.SetDefine(TEXT("MATERIAL_SHADINGMODEL_SINGLELAYERWATER"), TEXT("1"));
		NumSetMaterials++;
	}
	if (NumSetMaterials == 1)
	{
		OutEnvironment.SetDefine(TEXT("MATERIAL_SINGLE_SHADINGMODEL"), TEXT("1"));
	}
	ensure(NumSetMaterials != 0);
}
