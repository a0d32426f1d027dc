//! Numbers that a design varies, and numbers that follow them.

use crate::scene::{Parameter, Scene, SceneError, range_around};
use crate::sensitivity::Variable;

/// Numbers that a design varies, and what stays fixed meanwhile.
///
/// ```
/// use whiskmap::design::DesignVaried;
/// use whiskmap::scene::Parameter;
///
/// let base = DesignVaried { keeps_taper: true, ..Parameter::BaseRadiusUm.into() };
/// assert_eq!(base.variables.len(), 1);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct DesignVaried {
    /// Parameters of the scene that vary, and [`Variable::DistanceMm`] for the distance: `[variable]`, each once.
    pub variables: Vec<DesignVariable>,
    /// True if the taper stays as it is where a radius varies, so that the other radius follows. Otherwise the radius at the tip stays.
    pub keeps_taper: bool,
    /// Distance over the whisker's length, dimensionless, in place of the distance of the targets; `None` for a distance in mm.
    pub distance_to_length: Option<f64>,
}

/// Number that a design varies, with its limits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DesignVariable {
    /// Parameter of the scene, or the distance.
    pub variable: Variable,
    /// Limits `[least, greatest]` in the unit of the variable, within the limits of the scene; `None` for the limits of the scene alone.
    pub limits: Option<[f64; 2]>,
}

impl From<Variable> for DesignVaried {
    fn from(variable: Variable) -> Self {
        Self::from_iter([DesignVariable { variable, limits: None }])
    }
}

impl From<Parameter> for DesignVaried {
    fn from(parameter: Parameter) -> Self {
        Variable::from(parameter).into()
    }
}

impl FromIterator<DesignVariable> for DesignVaried {
    fn from_iter<I: IntoIterator<Item = DesignVariable>>(variables: I) -> Self {
        Self {
            variables: variables.into_iter().collect(),
            keeps_taper: false,
            distance_to_length: None,
        }
    }
}

impl DesignVaried {
    /// Returns the warnings of the scene with these `values`, as [`Self::scene_at`] returns it, that the `scene` itself does not have.
    #[must_use]
    pub fn warnings(&self, scene: &Scene, distance_mm: f64, values: &[f64]) -> Vec<String> {
        let known = scene.warnings();
        let solution = self.scene_at(scene, distance_mm, values);
        let found = solution.map_or_else(|_| Vec::new(), |solution| solution.warnings());
        let is_new = |warning: &String| !known.contains(warning);
        found.into_iter().filter(is_new).collect()
    }

    /// Returns the numbers of `scene` that differ with these `values` of the varied ones, `[variable]`: those, and the ones that follow. A distance is no number
    /// of a scene.
    #[must_use]
    pub fn changes(&self, scene: &Scene, values: &[f64]) -> Vec<(Parameter, f64)> {
        let taper = scene.whisker.taper();
        let mut changes = Vec::with_capacity(values.len() + 1);
        for (design_variable, &value) in self.variables.iter().zip(values) {
            let Variable::Parameter(parameter) = design_variable.variable else {
                continue;
            };
            changes.push((parameter, value));
            match parameter {
                Parameter::BaseRadiusUm if self.keeps_taper => {
                    changes.push((Parameter::Taper, taper));
                }
                Parameter::TipRadiusUm if self.keeps_taper => {
                    changes.push((Parameter::BaseRadiusUm, value / (1.0 - taper)));
                }
                _ => {}
            }
        }
        changes
    }
}

impl DesignVaried {
    /// Returns the scene with these `values` of the varied numbers, `[variable]`, in front of its pole alone: at `distance_mm`, unless the design
    /// varies the distance or gives it as a part of the length.
    ///
    /// # Errors
    /// If the scene would be refused with them.
    pub fn scene_at(
        &self,
        scene: &Scene,
        distance_mm: f64,
        values: &[f64],
    ) -> Result<Scene, SceneError> {
        let varied = self;
        DesignScene { scene, varied, distance_mm }.at(values)
    }
}

/// Scene of a design with its varied numbers, in front of one pole.
pub(super) struct DesignScene<'a> {
    /// Scene of which the numbers vary.
    pub scene: &'a Scene,
    pub varied: &'a DesignVaried,
    /// Distance in mm that the targets give.
    pub distance_mm: f64,
}

impl DesignScene<'_> {
    /// Returns true if `parameter` is one of the varied numbers.
    fn varies(&self, parameter: Parameter) -> bool {
        let wanted = Variable::from(parameter);
        self.varied.variables.iter().any(|design_variable| design_variable.variable == wanted)
    }

    /// Returns the value of variable `i` in the scene, in its unit; `None` if the scene does not give it.
    pub fn scene_value(&self, i: usize) -> Option<f64> {
        match self.varied.variables[i].variable {
            Variable::DistanceMm => Some(self.scene_distance_mm()),
            variable => variable.value(self.scene),
        }
    }

    /// Distance in mm before anything varies.
    fn scene_distance_mm(&self) -> f64 {
        let part = self.varied.distance_to_length;
        part.map_or(self.distance_mm, |part| part * self.scene.whisker.length_mm)
    }

    /// Returns the scene with these `values` of the varied numbers, `[variable]`, in front of its pole alone. The grid has the pole's distance
    /// alone, because other distances would limit the accepted values.
    pub fn at(&self, values: &[f64]) -> Result<Scene, SceneError> {
        let mut builder = self.scene.to_builder();
        let mut length_mm = self.scene.whisker.length_mm;
        for (parameter, value) in self.varied.changes(self.scene, values) {
            match parameter {
                Parameter::LengthMm => length_mm = value,
                Parameter::TipExtensionMm => {
                    length_mm += value - parameter.value(self.scene).unwrap_or_default();
                }
                _ => {}
            }
            builder = builder.set(parameter, value);
        }
        let varied = self.varied.variables.iter().zip(values);
        let distance = varied
            .filter(|(design_variable, _)| design_variable.variable == Variable::DistanceMm)
            .map(|(_, value)| *value)
            .next();
        let of_length = || Some(self.varied.distance_to_length? * length_mm);
        let distance_mm = distance.or_else(of_length).unwrap_or(self.distance_mm);
        builder.distance_mm([distance_mm]).build()
    }

    /// Returns the range `[least, greatest]` of each varied number with all others as in `values`, in its unit: `[variable]`. The range of the
    /// scene is the error of a variable of which that range has no value within its limits.
    pub fn ranges(&self, values: &[f64]) -> Vec<Result<[f64; 2], [f64; 2]>> {
        let range = |i: usize| {
            let mut moved = values.to_vec();
            let [least, most] = range_around(values[i], |value| {
                moved[i] = value;
                self.at(&moved).is_ok()
            });
            let limits = self.varied.variables[i].limits;
            let [low, high] = limits.unwrap_or([f64::NEG_INFINITY, f64::INFINITY]);
            let range = [least.max(low), most.min(high)];
            (range[0] <= range[1]).then_some(range).ok_or([least, most])
        };
        (0..values.len()).map(range).collect()
    }

    /// Returns the variables of derivatives in whose directions each varied number of `scene` goes, with factors: `[variable][direction]`.
    pub fn directions(&self, scene: &Scene) -> Vec<Vec<(Variable, f64)>> {
        let parameter = Variable::Parameter;
        let direction = |design_variable: &DesignVariable| {
            let mut direction = vec![(design_variable.variable, 1.0)];
            let keeps_taper = self.varied.keeps_taper || self.varies(Parameter::Taper);
            let tip_to_base = scene.whisker.tip_radius_um / scene.whisker.base_radius_um;
            match design_variable.variable {
                Variable::Parameter(Parameter::BaseRadiusUm) if keeps_taper => {
                    direction.push((parameter(Parameter::TipRadiusUm), tip_to_base));
                }
                Variable::Parameter(Parameter::TipRadiusUm) if keeps_taper => {
                    direction.push((parameter(Parameter::BaseRadiusUm), 1.0 / tip_to_base));
                }
                Variable::Parameter(Parameter::LengthMm | Parameter::TipExtensionMm) => {
                    let part = self.varied.distance_to_length;
                    direction.extend(part.map(|part| (Variable::DistanceMm, part)));
                }
                _ => {}
            }
            direction
        };
        self.varied.variables.iter().map(direction).collect()
    }
}
