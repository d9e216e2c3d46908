//! The calls of Vulkan: a device, a pipeline of one compute shader, and its statistics.
//!
//! All unsafe code of the test is here. The objects that are made live until the process ends.

use std::ffi::{CStr, CString};

use ash::khr::pipeline_executable_properties as executable;
use ash::vk;

/// A device, and what it is called.
pub struct Device {
    device: ash::Device,
    executables: executable::Device,
    driver: String,
    _entry: ash::Entry,
}

/// Why a device or a pipeline could not be made.
pub type Error = Box<dyn std::error::Error>;

impl Device {
    /// Opens the first device of the driver.
    ///
    /// # Errors
    ///
    /// There is no Vulkan, no device, or it has no statistics.
    pub fn open() -> Result<Self, Error> {
        // SAFETY: the loader is the system's Vulkan library, and `_entry` keeps it loaded.
        let entry = unsafe { ash::Entry::load() }?;
        let application = vk::ApplicationInfo::default().api_version(vk::API_VERSION_1_3);
        let info = vk::InstanceCreateInfo::default().application_info(&application);
        // SAFETY: `info` and what it refers to outlive the call.
        let instance = unsafe { entry.create_instance(&info, None) }?;
        // SAFETY: the instance is valid.
        let devices = unsafe { instance.enumerate_physical_devices() }?;
        let physical = *devices.first().ok_or("the driver has no device")?;
        let mut version = vk::PhysicalDeviceDriverProperties::default();
        let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut version);
        // SAFETY: the device is of this instance, and the structures are valid.
        unsafe { instance.get_physical_device_properties2(physical, &mut properties) };
        let text = |name: Result<&CStr, _>| name.unwrap_or_default().to_string_lossy().into_owned();
        let [info, name] = [version.driver_info_as_c_str(), version.driver_name_as_c_str()];
        let driver = format!("{} ({})", text(info), text(name));

        let queue = [vk::DeviceQueueCreateInfo::default().queue_priorities(&[1.0])];
        let extensions = [executable::NAME.as_ptr()];
        let mut features = vk::PhysicalDevicePipelineExecutablePropertiesFeaturesKHR::default()
            .pipeline_executable_info(true);
        let info = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queue)
            .enabled_extension_names(&extensions)
            .push_next(&mut features);
        // SAFETY: `info` and what it refers to outlive the call.
        let device = unsafe { instance.create_device(physical, &info, None) }?;
        let executables = executable::Device::new(&instance, &device);
        Ok(Self { device, executables, driver, _entry: entry })
    }

    /// Name and version of the driver.
    pub fn driver(&self) -> &str {
        &self.driver
    }

    /// Compiles a module with one compute shader and returns the statistics that the driver has, by
    /// name.
    ///
    /// # Errors
    ///
    /// The module has no entry point, or the driver refuses it.
    pub fn statistics(&self, words: &[u32]) -> Result<Vec<(String, u64)>, Error> {
        let bindings = bindings(words);
        let entry_point = entry_point(words).ok_or("the module has no entry point")?;
        let info = vk::DescriptorSetLayoutCreateInfo::default().bindings(&bindings);
        // SAFETY: `info` and what it refers to outlive the call.
        let sets = [unsafe { self.device.create_descriptor_set_layout(&info, None) }?];
        let info = vk::PipelineLayoutCreateInfo::default().set_layouts(&sets);
        // SAFETY: as above.
        let layout = unsafe { self.device.create_pipeline_layout(&info, None) }?;
        let info = vk::ShaderModuleCreateInfo::default().code(words);
        // SAFETY: the words are a module that naga validated before it wrote it.
        let module = unsafe { self.device.create_shader_module(&info, None) }?;
        let stage = vk::PipelineShaderStageCreateInfo::default()
            .stage(vk::ShaderStageFlags::COMPUTE)
            .module(module)
            .name(&entry_point);
        let info = vk::ComputePipelineCreateInfo::default()
            .flags(vk::PipelineCreateFlags::CAPTURE_STATISTICS_KHR)
            .stage(stage)
            .layout(layout);
        // SAFETY: the layout has all bindings that the module declares, and the entry point is its
        // own.
        let made = unsafe {
            self.device.create_compute_pipelines(vk::PipelineCache::null(), &[info], None)
        };
        let pipeline = made.map_err(|(_, error)| error)?.into_iter().next();
        let info = vk::PipelineExecutableInfoKHR::default()
            .pipeline(pipeline.ok_or("the driver made no pipeline")?);
        // SAFETY: the pipeline was made with its statistics captured.
        let found = unsafe { self.executables.get_pipeline_executable_statistics(&info) }?;
        Ok(found
            .iter()
            .filter(|statistic| {
                statistic.format == vk::PipelineExecutableStatisticFormatKHR::UINT64
            })
            .map(|statistic| {
                let name = statistic.name_as_c_str().unwrap_or_default();
                // SAFETY: the format says that the value is a 64-bit word.
                (name.to_string_lossy().into_owned(), unsafe { statistic.value.u64 })
            })
            .collect())
    }
}

/// The words of a module that is stored as bytes.
pub fn words(code: &[u8]) -> Vec<u32> {
    code.as_chunks().0.iter().map(|bytes| u32::from_le_bytes(*bytes)).collect()
}

/// The instructions of a module: the number of the operation, then its operands.
fn instructions(words: &[u32]) -> impl Iterator<Item = (u32, &[u32])> {
    let mut rest = words.get(5..).unwrap_or(&[]);
    std::iter::from_fn(move || {
        let &first = rest.first()?;
        let length = ((first >> 16) as usize).clamp(1, rest.len());
        let (instruction, after) = rest.split_at(length);
        rest = after;
        Some((first & 0xffff, &instruction[1..]))
    })
}

/// The name of the module's first entry point.
fn entry_point(words: &[u32]) -> Option<CString> {
    const ENTRY_POINT: u32 = 15;
    let (_, operands) = instructions(words).find(|&(operation, _)| operation == ENTRY_POINT)?;
    let bytes = operands.get(2..)?.iter().flat_map(|word| word.to_le_bytes());
    CString::new(bytes.take_while(|&byte| byte != 0).collect::<Vec<u8>>()).ok()
}

/// The bindings of set 0, from the decorations of the module.
fn bindings(words: &[u32]) -> Vec<vk::DescriptorSetLayoutBinding<'static>> {
    const VARIABLE: u32 = 59;
    const DECORATE: u32 = 71;
    const BINDING: u32 = 33;
    const UNIFORM: u32 = 2;
    let (mut numbers, mut classes) = (Vec::new(), Vec::new());
    for (operation, operands) in instructions(words) {
        match (operation, operands) {
            (DECORATE, &[id, BINDING, number, ..]) => numbers.push((id, number)),
            (VARIABLE, &[_, id, class, ..]) => classes.push((id, class)),
            _ => {}
        }
    }
    let binding = |&(id, number): &(u32, u32)| {
        let is_uniform = classes.contains(&(id, UNIFORM));
        let kind = match is_uniform {
            true => vk::DescriptorType::UNIFORM_BUFFER,
            false => vk::DescriptorType::STORAGE_BUFFER,
        };
        vk::DescriptorSetLayoutBinding::default()
            .binding(number)
            .descriptor_type(kind)
            .descriptor_count(1)
            .stage_flags(vk::ShaderStageFlags::COMPUTE)
    };
    numbers.iter().map(binding).collect()
}
