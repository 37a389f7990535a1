//% # The base pass writing one pixel of a material with a shading model.
//% for model in models
#define ${model.define} 1
//% end
#include "prelude.ush"

struct FMaterialPixelParameters
{
	float4 X;
	half3 WorldNormal;
	half3 CameraVector;
	half3x3 TangentToWorld;
};

half GetMaterialCustomData0( FMaterialPixelParameters Parameters ) { return Parameters.X.x; }
half GetMaterialCustomData1( FMaterialPixelParameters Parameters ) { return Parameters.X.y; }
//% for node in nodes
#define NUM_MATERIAL_OUTPUTS_${node.upper} ${node.count}
//% for output in node.outputs
${output.type} ${node.function}${output.index}( FMaterialPixelParameters Parameters ) { return Parameters.X${output.swizzle}; }
//% end
//% end

#include "DeferredShadingCommon.ush"
#include "ShadingModelsMaterial.ush"

float4 main( float4 X : TEXCOORD0 ) : SV_Target0
{
	FMaterialPixelParameters Parameters = (FMaterialPixelParameters)0;
	Parameters.X = X;
	FGBufferData GBuffer = (FGBufferData)0;
	GBuffer.GBufferAO = X.x;
	SetGBufferForShadingModel( GBuffer, Parameters, X.x, X.xyz, X.y, X.z, X.w, X.x, X.yzw, X.x, X.y, ${shading_model} );
	return GBuffer.CustomData + GBuffer.Metallic + GBuffer.Anisotropy + GBuffer.ShadingModelID;
}
