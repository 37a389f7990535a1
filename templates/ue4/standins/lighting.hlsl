//% # A light that shades one pixel of a shading model, with the tree's own dispatcher.
#include "prelude.ush"
#include "ShadingModels.ush"

float4 main( float4 X : TEXCOORD0 ) : SV_Target0
{
	FGBufferData GBuffer = (FGBufferData)0;
	GBuffer.WorldNormal = X.xyz;
	GBuffer.WorldTangent = X.yzx;
	GBuffer.DiffuseColor = X.x;
	GBuffer.SpecularColor = X.y;
	GBuffer.BaseColor = X.z;
	GBuffer.Metallic = X.x;
	GBuffer.Specular = X.y;
	GBuffer.Roughness = X.z;
	GBuffer.CustomData = X;
	GBuffer.ShadingModelID = ${shading_model};
	FAreaLight AreaLight = (FAreaLight)0;
	AreaLight.SphereSinAlpha = X.x;
	AreaLight.LineCosSubtended = X.y;
	AreaLight.FalloffColor = X.z;
	FShadowTerms Shadow = (FShadowTerms)0;
	Shadow.SurfaceShadow = X.x;
	Shadow.TransmissionShadow = X.y;
	FDirectLighting Lighting = IntegrateBxDF( GBuffer, X.xyz, X.yzw, X.zwx, X.x, X.y, AreaLight, Shadow );
	return float4( Lighting.Diffuse + Lighting.Specular + Lighting.Transmission, 1 );
}
