// ${banner}

#pragma once

#include "CoreMinimal.h"
#include "UObject/ObjectMacros.h"
#include "MaterialExpressionIO.h"
#include "Materials/MaterialExpressionCustomOutput.h"
#include "MaterialExpression${Node}.generated.h"

// Parameters of the shading model ${display_text} that no pin of the material feeds.
UCLASS(MinimalAPI, collapsecategories, hidecategories = Object)
class UMaterialExpression${Node} : public UMaterialExpressionCustomOutput
{
	GENERATED_UCLASS_BODY()

//% for input in inputs
//% for line in input.comment
	// ${line.text}
//% end
	UPROPERTY(meta = (RequiredInput = "false", ToolTip = ${input.tip}))
	FExpressionInput ${input.name};

//% end
#if WITH_EDITOR
	virtual int32 Compile(class FMaterialCompiler* Compiler, int32 OutputIndex) override;
	virtual void GetCaption(TArray<FString>& OutCaptions) const override;
#endif

	virtual int32 GetNumOutputs() const override;
	virtual FString GetFunctionName() const override;
	virtual FString GetDisplayName() const override;
};
