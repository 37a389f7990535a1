// Stand-in for tests: a pixel of the GBuffer, for people. Not engine code.

#pragma once

#include "Engine/EngineTypes.h"

#define PIXEL_INSPECTOR_SHADINGMODELID_UNLIT 0
#define PIXEL_INSPECTOR_SHADINGMODELID_DEFAULT_LIT 1
#define PIXEL_INSPECTOR_SHADINGMODELID_CLEAR_COAT 4
#define PIXEL_INSPECTOR_SHADINGMODELID_MASK 0xF

class PixelInspectorResult
{
public:
	EMaterialShadingModel DecodeShadingModel(float InPackedChannel);
	void DecodeCustomData(const FVector4& InCustomData);

	TEnumAsByte<EMaterialShadingModel> ShadingModel;
	float ClearCoat = 0.0f;
};
