// Stand-in for tests. Not engine code.

#include "PixelInspectorResult.h"

	EMaterialShadingModel PixelInspectorResult::DecodeShadingModel(float InPackedChannel)
	{
		const int32 Id = static_cast<int32>(InPackedChannel * 255.0f + 0.5f) & PIXEL_INSPECTOR_SHADINGMODELID_MASK;
		switch (Id)
		{
		case PIXEL_INSPECTOR_SHADINGMODELID_UNLIT:
			return EMaterialShadingModel::MSM_Unlit;
		case PIXEL_INSPECTOR_SHADINGMODELID_DEFAULT_LIT:
			return EMaterialShadingModel::MSM_DefaultLit;
		case PIXEL_INSPECTOR_SHADINGMODELID_CLEAR_COAT:
			return EMaterialShadingModel::MSM_ClearCoat;
		};
		return EMaterialShadingModel::MSM_DefaultLit;
	}

	void PixelInspectorResult::DecodeCustomData(const FVector4& InCustomData)
	{
		switch (ShadingModel)
		{
		case EMaterialShadingModel::MSM_ClearCoat:
			ClearCoat = InCustomData.X;
			break;
		default:
			break;
		}
	}
